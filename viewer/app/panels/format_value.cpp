#include "viewer/app/panels/format_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "pillarfield/status.h"
#include "viewer/style/quantity.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

constexpr double kUnknown = Units::kUnknown;

double plane(const PillarValues& values, Uncertainty which) {
  if (!values.uncertainty) return kUnknown;
  return static_cast<double>((*values.uncertainty)[static_cast<std::size_t>(which)]);
}

bool is_ambiguous(const PillarValues& values) { return (values.status & status::kAmbiguous) != 0; }

struct Ends {
  double low, high;
};

/// Interval of phi; beyond pi where it crosses it.
Ends phi_ends(const PillarValues& values) {
  const double low = plane(values, Uncertainty::phi_low);
  const double high = plane(values, Uncertainty::phi_high);
  return {low, high < low ? high + 2 * std::numbers::pi : high};
}

}  // namespace

DirectionDeviation direction_deviation(const PillarValues& values) {
  const auto x = static_cast<double>(values.shear_x);
  const auto y = static_cast<double>(values.shear_y);
  const auto n = static_cast<double>(values.normal);
  const double sx = plane(values, Uncertainty::shear_x);
  const double sy = plane(values, Uncertainty::shear_y);
  const double sn = plane(values, Uncertainty::normal);
  const double shear = std::hypot(x, y);
  const double force = std::hypot(shear, n);
  if (!(force > 0)) return {kUnknown, kUnknown, kUnknown};
  const double magnitude = std::hypot(x * sx, y * sy, n * sn) / force;
  if (!(shear > 0)) return {magnitude, std::max(sx, sy) / force, kUnknown};
  const double along = std::hypot(x * sx, y * sy) / shear;
  const double across = std::hypot(y * sx, x * sy) / shear;
  return {magnitude, std::hypot(n * along, shear * sn) / (force * force), across / shear};
}

const char* element_name(const Skin& skin) { return skin.has_pillars() ? "pillar" : "sensel"; }

std::string format_pillar(PillarIndex pillar) {
  return fmt::format("row {}, column {}", pillar.row, pillar.col);
}

std::string format_place(const ForceFieldView& forces, PillarIndex pillar,
                         const Pitch& element_pitch_mm, const Units& units) {
  const double x = (pillar.col + 0.5 - 0.5 * forces.cols) * element_pitch_mm.col_mm;
  const double y = (0.5 * forces.rows - pillar.row - 0.5) * element_pitch_mm.row_mm;
  return fmt::format("x {}, y {}",
                     units.fixed(Dimension::none, units.shown(Dimension::length, x), 2),
                     units.fixed(Dimension::length, y, 2));
}

std::string format_count(double counts) {
  if (!std::isfinite(counts) || counts != std::round(counts)) return three_digits(counts);
  return Units().fixed(Dimension::none, counts, 0);
}

std::string format_readings(const PillarValues& values) {
  std::string words = values.has_pillars ? "readings 1–4: " : "reading: ";
  const std::span<const float> readings = values.readings;
  for (const float reading : readings.first(values.has_pillars ? 4 : 1)) {
    words += format_count(static_cast<double>(reading)) + "  ";
  }
  return words + "counts";
}

std::string format_status(std::uint8_t status) {
  const Region region = region_of(status);
  std::string words;
  if (region == Region::none) {
    words = (status & status::kSaturated) != 0 ? "no usable sensel" : "no contact";
  } else if (region == Region::opposite) {
    words = "opposite sensels";
  } else {
    words = fmt::format("region {}", name_of(region));
  }
  if ((status & status::kFromNeighbours) != 0) {
    words += ", resolved from the contact";
  } else if ((status & status::kAmbiguous) != 0) {
    words += ", ambiguous";
  }
  if ((status & status::kSaturated) != 0) words += ", saturated";
  if ((status & status::kInconsistent) != 0) words += ", inconsistent";
  return words;
}

std::string format_sensel_status(std::uint8_t status) {
  if ((status & status::kSaturated) != 0) return "saturated";
  if ((status & status::kInconsistent) != 0) return "no reading";
  return (status & status::kLoaded) != 0 ? "in contact" : "no contact";
}

std::array<ShownValue, 3> shown_direction(const PillarValues& values, const Units& units) {
  const auto magnitude = static_cast<double>(values.magnitude);
  const auto theta = static_cast<double>(values.theta);
  const auto phi = static_cast<double>(values.phi);
  if (is_ambiguous(values) && values.uncertainty) {
    const auto between = [&](const char* label, Dimension dimension, double value,
                             const Ends& ends) {
      return units.readout_between(label, dimension, value, ends.low, ends.high);
    };
    const auto ends = [&](Uncertainty low, Uncertainty high) {
      return Ends{plane(values, low), plane(values, high)};
    };
    return {between("magnitude", Dimension::force, magnitude,
                    ends(Uncertainty::magnitude_low, Uncertainty::magnitude_high)),
            between("θ", Dimension::angle, theta,
                    ends(Uncertainty::theta_low, Uncertainty::theta_high)),
            between("φ", Dimension::angle, phi, phi_ends(values))};
  }
  const DirectionDeviation deviation = direction_deviation(values);
  return {units.readout("magnitude", Dimension::force, magnitude, deviation.magnitude),
          units.readout("θ", Dimension::angle, theta, deviation.theta),
          units.readout("φ", Dimension::angle, phi, deviation.phi)};
}

std::array<ShownValue, 3> shown_components(const PillarValues& values, const Units& units) {
  const auto shown = [&](const char* label, float force, Uncertainty deviation, ComponentEnd low) {
    const auto value = static_cast<double>(force);
    if (!is_ambiguous(values) || !values.uncertainty) {
      return units.readout(label, Dimension::force, value, plane(values, deviation));
    }
    const auto* const end = &values.component_ends[static_cast<std::size_t>(low)];
    return units.readout_between(label, Dimension::force, value, static_cast<double>(end[0]),
                                 static_cast<double>(end[1]));
  };
  return {shown("normal", values.normal, Uncertainty::normal, ComponentEnd::normal_low),
          shown("shear x", values.shear_x, Uncertainty::shear_x, ComponentEnd::shear_x_low),
          shown("shear y", values.shear_y, Uncertainty::shear_y, ComponentEnd::shear_y_low)};
}

std::vector<ShownValue> shown_forces(const PillarValues& values, const Skin& skin,
                                     const Units& units) {
  const auto components = shown_components(values, units);
  if (values.has_pillars) return {components.begin(), components.end()};
  const auto kpa = static_cast<double>(kpa_per_newton(skin));
  return {components.front(),
          units.readout("pressure", Dimension::pressure, kpa * static_cast<double>(values.normal),
                        kpa * plane(values, Uncertainty::normal))};
}

std::string table_number(double value) {
  if (value == 0 || !(std::abs(value) < 0.1)) return three_digits(value);
  return Units().fixed(Dimension::none, value, 4);
}

std::string format_quantity(const QuantityColumn& column, const ContactQuantities& contact,
                            const PressureUnit& unit) {
  const double value = column.get(contact) / (is_pressure(column) ? unit.kpa : 1);
  if (column.kind == ColumnKind::word) return value == 0 ? "–" : column.word(value);
  const bool is_bound = std::string_view(column.name) == "friction" && contact.friction &&
                        contact.friction_source == FrictionSource::at_least;
  return (is_bound ? "≥ " : "") + table_number(value);
}

}  // namespace pillarfield::viewer
