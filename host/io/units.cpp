#include "io/units.h"

#include <algorithm>
#include <iterator>
#include <string>

#include "io/plain/text_cells.h"

namespace pillarfield {
namespace {

struct Unit {
  std::string_view name;  ///< lower case, in Latin-1
  Dimension dimension;
  double size;
};

using enum Dimension;
constexpr Unit kUnits[] = {{"mm", length, 1},
                           {"millimeter", length, 1},
                           {"millimeters", length, 1},
                           {"milimeters", length, 1},
                           {"cm", length, 10},
                           {"centimeter", length, 10},
                           {"centimeters", length, 10},
                           {"in", length, 25.4},
                           {"inch", length, 25.4},
                           {"inches", length, 25.4},
                           {"\"", length, 25.4},
                           {"mm2", area, 1},
                           {"cm2", area, 100},
                           {"m2", area, 1e6},
                           {"in2", area, 645.16},
                           {"kpa", pressure, 1e-3},
                           {"psi", pressure, 6.894757293168e-3},
                           {"mmhg", pressure, 0.133322387415e-3},
                           {"mpa", pressure, 1},
                           {"hpa", pressure, 1e-4},
                           {"pa", pressure, 1e-6},
                           {"n/cm2", pressure, 1e-2},
                           {"n/mm2", pressure, 1},
                           {"kg/cm2", pressure, 9.80665e-2},
                           {"kgf/cm2", pressure, 9.80665e-2},
                           {"g/cm2", pressure, 9.80665e-5},
                           {"bar", pressure, 1e-1},
                           {"mbar", pressure, 1e-4},
                           {"n", force, 1},
                           {"newton", force, 1},
                           {"newtons", force, 1},
                           {"lb", force, 4.4482216152605},
                           {"lbs", force, 4.4482216152605},
                           {"kg", force, 9.80665},
                           {"g", force, 9.80665e-3},
                           {"s", time, 1},
                           {"sec", time, 1},
                           {"secs", time, 1},
                           {"seconds", time, 1},
                           {"ms", time, 1e-3},
                           {"msec", time, 1e-3},
                           {"millis", time, 1e-3},
                           {"us", time, 1e-6},
                           {"\xb5s", time, 1e-6},
                           {"micros", time, 1e-6},
                           {"ns", time, 1e-9},
                           {"nanos", time, 1e-9}};

}  // namespace

std::optional<double> unit_size(Dimension dimension, std::string_view name) {
  std::string known;
  for (const char letter : without_blanks(name)) {
    if (letter == '\xb2') known += '2';
    if (letter != '^' && letter != '\xb2' && letter != '\xc2') known += letter;
  }
  known = lower_case(known);
  const auto* const unit = std::ranges::find_if(
      kUnits, [&](const Unit& each) { return each.dimension == dimension && each.name == known; });
  return unit == std::end(kUnits) ? std::nullopt : std::optional(unit->size);
}

}  // namespace pillarfield
