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

constexpr Unit kLengths[] = {{"mm", 1},    {"millimeter", 1},  {"milimeter", 1}, {"cm", 10},
                             {"in", 25.4}, {"centimeter", 10}, {"inch", 25.4},   {"inche", 25.4},
                             {"\"", 25.4}, {"m", 1000},        {"um", 1e-3},     {"\xb5m", 1e-3}};
constexpr Unit kAreas[] = {{"mm2", 1}, {"cm2", 100}, {"m2", 1e6}, {"in2", 645.16}};
constexpr double kPsi = 6.894757293168e-3;
constexpr double kMmHg = 0.133322387415e-3;
constexpr double kKgf = 9.80665;
constexpr double kLbf = 4.4482216152605;
constexpr Unit kPressures[] = {{"kpa", 1e-3},
                               {"kilopascal", 1e-3},
                               {"kn/m2", 1e-3},
                               {"pa", 1e-6},
                               {"n/m2", 1e-6},
                               {"pascal", 1e-6},
                               {"mpa", 1},
                               {"megapascal", 1},
                               {"n/mm2", 1},
                               {"hpa", 1e-4},
                               {"n/cm2", 1e-2},
                               {"bar", 1e-1},
                               {"mbar", 1e-4},
                               {"psi", kPsi},
                               {"lb/in2", kPsi},
                               {"lbf/in2", kPsi},
                               {"mmhg", kMmHg},
                               {"torr", kMmHg},
                               {"cmhg", 10 * kMmHg},
                               {"inhg", 25.4 * kMmHg},
                               {"atm", 0.101325},
                               {"cmh2o", 1e-5 * kKgf},
                               {"mmh2o", 1e-6 * kKgf},
                               {"kg/cm2", 1e-2 * kKgf},
                               {"kgf/cm2", 1e-2 * kKgf},
                               {"g/cm2", 1e-5 * kKgf},
                               {"gf/cm2", 1e-5 * kKgf},
                               {"kg/m2", 1e-6 * kKgf},
                               {"kgf/m2", 1e-6 * kKgf}};
constexpr Unit kForces[] = {{"n", 1},           {"newton", 1},      {"kn", 1000}, {"mn", 1e-3},
                            {"kg", kKgf},       {"kgf", kKgf},      {"lb", kLbf}, {"lbf", kLbf},
                            {"g", 1e-3 * kKgf}, {"gf", 1e-3 * kKgf}};
constexpr Unit kTimes[] = {{"s", 1},        {"sec", 1},      {"second", 1}, {"ms", 1e-3},
                           {"msec", 1e-3},  {"milli", 1e-3}, {"us", 1e-6},  {"\xb5s", 1e-6},
                           {"micro", 1e-6}, {"ns", 1e-9},    {"nano", 1e-9}};

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
  if (const std::size_t metre = known.find("metre"); metre != std::string::npos)
    known.replace(metre, 5, "meter");
  const std::span<const Unit> units = kUnits[static_cast<std::size_t>(dimension)];
  auto unit = std::ranges::find(units, std::string_view(known), &Unit::name);
  if (unit == units.end() && known.size() > 2 && known.ends_with('s')) {
    unit =
        std::ranges::find(units, std::string_view(known).substr(0, known.size() - 1), &Unit::name);
  }
  return unit == units.end() ? std::nullopt : std::optional(unit->size);
}

}  // namespace pillarfield
