#include "io/units.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>

#include "io/plain/text_cells.h"

namespace pillarfield {
namespace {

struct Unit {
  std::string_view name;  ///< lower case, in Latin-1
  double size;
};

constexpr Unit kLengths[] = {{"mm", 1},           {"millimeter", 1}, {"millimeters", 1},
                             {"milimeters", 1},   {"cm", 10},        {"centimeter", 10},
                             {"centimeters", 10}, {"in", 25.4},      {"inch", 25.4},
                             {"inches", 25.4},    {"\"", 25.4}};
constexpr Unit kAreas[] = {{"mm2", 1}, {"cm2", 100}, {"m2", 1e6}, {"in2", 645.16}};
constexpr Unit kPressures[] = {{"kpa", 1e-3},
                               {"psi", 6.894757293168e-3},
                               {"mmhg", 0.133322387415e-3},
                               {"mpa", 1},
                               {"hpa", 1e-4},
                               {"pa", 1e-6},
                               {"n/cm2", 1e-2},
                               {"n/mm2", 1},
                               {"kg/cm2", 9.80665e-2},
                               {"kgf/cm2", 9.80665e-2},
                               {"g/cm2", 9.80665e-5},
                               {"bar", 1e-1},
                               {"mbar", 1e-4}};
constexpr Unit kForces[] = {{"n", 1},
                            {"newton", 1},
                            {"newtons", 1},
                            {"lb", 4.4482216152605},
                            {"lbs", 4.4482216152605},
                            {"kg", 9.80665},
                            {"g", 9.80665e-3}};
constexpr Unit kTimes[] = {{"s", 1},        {"sec", 1},       {"secs", 1},      {"seconds", 1},
                           {"ms", 1e-3},    {"msec", 1e-3},   {"millis", 1e-3}, {"us", 1e-6},
                           {"\xb5s", 1e-6}, {"micros", 1e-6}, {"ns", 1e-9},     {"nanos", 1e-9}};

/// In the order of Dimension.
constexpr std::array<std::span<const Unit>, 5> kUnits = {kLengths, kAreas, kPressures, kForces,
                                                         kTimes};

}  // namespace

std::optional<double> unit_size(Dimension dimension, std::string_view name) {
  std::string known;
  for (const char letter : without_blanks(name)) {
    if (letter == '\xb2') known += '2';
    if (letter != '^' && letter != '\xb2' && letter != '\xc2') known += letter;
  }
  known = lower_case(known);
  const std::span<const Unit> units = kUnits[static_cast<std::size_t>(dimension)];
  const auto unit = std::ranges::find(units, std::string_view(known), &Unit::name);
  return unit == units.end() ? std::nullopt : std::optional(unit->size);
}

}  // namespace pillarfield
