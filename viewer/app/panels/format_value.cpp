#include "viewer/app/panels/format_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

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

namespace {

std::string format_percent(std::uint64_t part, std::uint64_t all) {
  if (all == 0) return "–";
  return fmt::format("{:.0f} %", 100 * static_cast<double>(part) / static_cast<double>(all));
}

/// "42 %", or "42 % / 90 %" with the fraction resolved from the contact.
std::string format_ambiguous(const ContactQuantities& contact) {
  std::string share = format_percent(contact.ambiguous, contact.pillars);
  if (contact.resolved == 0) return share;
  return share + " / " + format_percent(contact.resolved, contact.ambiguous);
}

std::string format_friction(const ContactQuantities& contact) {
  return contact.friction ? fmt::format("{:.2f}", *contact.friction) : "–";
}

std::string format_slip(const ContactQuantities& contact) {
  return contact.slip == SlipState::unknown ? "–" : name_of(contact.slip);
}

/// "0.42 s"; "–" if it is not foretold, or will not slide.
std::string format_time_to_slip(const ContactQuantities& contact) {
  constexpr double kFarS = 60;
  const auto& forecast = contact.slip_forecast;
  if (!forecast || !forecast->time_s) return "–";
  if (*forecast->time_s > kFarS) return fmt::format("> {:.0f} s", kFarS);
  return fmt::format("{:.{}f} s", *forecast->time_s, *forecast->time_s < 9.95 ? 2 : 0);
}

/// Columns of pillars alone.
std::vector<ContactColumn> shear_columns() {
  return {{"shear", "shear force, N", "00000",
           [](const ContactQuantities& contact) {
             return three_digits(std::hypot(contact.shear_x_n, contact.shear_y_n));
           }},
          {"µ", "friction", "00.00", format_friction},
          {"slip", "sticking, partial or sliding", "sticking", format_slip},
          {"slips in", "seconds until the whole contact slides at the present rates", "00.0 s",
           format_time_to_slip},
          {"ambiguous", "fraction of pillars / fraction of these resolved from the contact",
           "00 % / 00 %", format_ambiguous}};
}

std::vector<ContactColumn> columns_of(SkinLayout layout) {
  std::vector<ContactColumn> columns{
      {"id", "constant while the contact is tracked", "000", nullptr},
      {"normal", "normal force, N", "00000",
       [](const ContactQuantities& contact) { return three_digits(contact.normal_n); }}};
  if (layout == SkinLayout::pillars) {
    for (const ContactColumn& column : shear_columns()) columns.push_back(column);
  }
  columns.push_back({"mean", "mean pressure", "0.0000", nullptr,
                     [](const ContactQuantities& contact) { return contact.mean_pressure_kpa; }});
  columns.push_back({"most", "largest pressure", "0.0000", nullptr,
                     [](const ContactQuantities& contact) { return contact.peak_pressure_kpa(); }});
  columns.push_back({"area", "mm²", "00000", [](const ContactQuantities& contact) {
                       return three_digits(contact.area_mm2);
                     }});
  columns.push_back(
      {"peak",
       layout == SkinLayout::pillars ? "largest normal force of a pillar, N"
                                     : "largest normal force of a sensel, N",
       "0.000", [](const ContactQuantities& contact) { return three_digits(contact.peak_n); }});
  return columns;
}

}  // namespace

const std::vector<ContactColumn>& contact_columns(SkinLayout layout) {
  static const std::vector<ContactColumn> of_pillars = columns_of(SkinLayout::pillars);
  static const std::vector<ContactColumn> of_sensels = columns_of(SkinLayout::sensels);
  return layout == SkinLayout::pillars ? of_pillars : of_sensels;
}

std::string format_slip_details(const ContactQuantities& contact) {
  std::string words;
  if (contact.friction_deviation) {
    words = fmt::format("standard deviation of µ  {:.2f}", *contact.friction_deviation);
  }
  const auto& forecast = contact.slip_forecast;
  if (!forecast) return words;
  const auto end = [](const std::optional<double>& time_s) {
    return time_s ? fmt::format("{:.2f} s", *time_s) : "never";
  };
  if (!words.empty()) words += "\n";
  words += forecast->low_s
               ? fmt::format("slips in {} … {} (95 %)", end(forecast->low_s), end(forecast->high_s))
               : "does not slip (95 %)";
  for (std::size_t i = 0; i < forecast->probability.size(); ++i) {
    words += fmt::format("\nslips within {} s  {:.0f} %", SlipForecast::kWithinS[i],
                         100 * forecast->probability[i]);
  }
  return words;
}

std::vector<std::string> format_contact(const std::string& name, const ContactQuantities& contact,
                                        SkinLayout layout, const PressureUnit& unit) {
  std::vector<std::string> words;
  for (const ContactColumn& column : contact_columns(layout)) {
    if (column.pressure_kpa != nullptr) {
      words.push_back(three_digits(column.pressure_kpa(contact) / unit.kpa));
    } else {
      words.push_back(column.words == nullptr ? name : column.words(contact));
    }
  }
  return words;
}

}  // namespace pillarfield::viewer
