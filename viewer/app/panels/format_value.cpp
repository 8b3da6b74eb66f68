#include "viewer/app/panels/format_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "viewer/app/panels/plot.h"
#include "viewer/style/quantity.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kMostDecimals = 6;

bool is_bounded(double value) { return std::abs(value) < 0.1 * kOpenN; }  // false for NaN

bool tells(double deviation) { return is_bounded(deviation) && deviation > 0; }

/// Number of decimals that show `digits` digits of `size`.
int decimals_of(double size, int digits) {
  const int first = static_cast<int>(std::floor(std::log10(size)));
  return std::clamp(digits - 1 - first, 0, kMostDecimals);
}

std::string fixed(double value, int decimals) {
  if (!is_bounded(value)) return "–";
  const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "\u2212" + text : text;
}

double plane(const PillarValues& values, Uncertainty which) {
  if (!values.uncertainty) return kUnknown;
  return static_cast<double>((*values.uncertainty)[static_cast<std::size_t>(which)]);
}

bool is_ambiguous(const PillarValues& values) { return (values.status & status::kAmbiguous) != 0; }

ShownValue with_deviation(const char* label, double value, double deviation,
                          std::string_view unit) {
  return {label, format_value(value, deviation), format_deviation(deviation), std::string(unit)};
}

/// A value known only as an interval.
ShownValue with_interval(const char* label, double value, Span ends, const char* unit) {
  return {label, format_value(value, ends.to - ends.from), format_interval(ends.from, ends.to),
          unit};
}

/// Interval of phi; beyond 180 degrees where it crosses pi.
Span phi_span(const PillarValues& values) {
  const double low = plane(values, Uncertainty::phi_low) * kDegrees;
  const double high = plane(values, Uncertainty::phi_high) * kDegrees;
  return {low, high < low ? high + 360 : high};
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
                         const Pitch& element_pitch_mm) {
  const double x = (pillar.col + 0.5 - 0.5 * forces.cols) * element_pitch_mm.col_mm;
  const double y = (0.5 * forces.rows - pillar.row - 0.5) * element_pitch_mm.row_mm;
  return fmt::format("x {}, y {} mm", fixed(x, 2), fixed(y, 2));
}

std::string format_count(double counts) {
  if (!std::isfinite(counts) || counts != std::round(counts)) return three_digits(counts);
  return fixed(counts, 0);
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

std::string format_value(double value, double deviation) {
  if (!tells(deviation)) return three_digits(value);
  return fixed(value, decimals_of(deviation, 2));
}

std::string format_deviation(double deviation) {
  if (!tells(deviation)) return {};
  return "± " + fixed(deviation, decimals_of(deviation, 2));
}

std::string format_interval(double low, double high) {
  if (!is_bounded(low) || !is_bounded(high)) return {};
  const double width = high - low;
  const int decimals = width > 0 ? decimals_of(width, 2) : 3;
  return fixed(low, decimals) + " … " + fixed(high, decimals);
}

std::array<ShownValue, 3> shown_direction(const PillarValues& values) {
  const auto magnitude = static_cast<double>(values.magnitude);
  const double theta = static_cast<double>(values.theta) * kDegrees;
  const double phi = static_cast<double>(values.phi) * kDegrees;
  if (is_ambiguous(values) && values.uncertainty) {
    const auto span = [&](Uncertainty low, Uncertainty high, double factor) {
      return Span{plane(values, low) * factor, plane(values, high) * factor};
    };
    return {with_interval("magnitude", magnitude,
                          span(Uncertainty::magnitude_low, Uncertainty::magnitude_high, 1), "N"),
            with_interval("θ", theta,
                          span(Uncertainty::theta_low, Uncertainty::theta_high, kDegrees), "°"),
            with_interval("φ", phi, phi_span(values), "°")};
  }
  const DirectionDeviation deviation = direction_deviation(values);
  return {with_deviation("magnitude", magnitude, deviation.magnitude, "N"),
          with_deviation("θ", theta, deviation.theta * kDegrees, "°"),
          with_deviation("φ", phi, deviation.phi * kDegrees, "°")};
}

std::array<ShownValue, 3> shown_components(const PillarValues& values) {
  const auto shown = [&](const char* label, float force, Uncertainty deviation, ComponentEnd low) {
    const auto value = static_cast<double>(force);
    if (!is_ambiguous(values) || !values.uncertainty) {
      return with_deviation(label, value, plane(values, deviation), "N");
    }
    const auto* const end = &values.component_ends[static_cast<std::size_t>(low)];
    return with_interval(label, value, {static_cast<double>(end[0]), static_cast<double>(end[1])},
                         "N");
  };
  return {shown("normal", values.normal, Uncertainty::normal, ComponentEnd::normal_low),
          shown("shear x", values.shear_x, Uncertainty::shear_x, ComponentEnd::shear_x_low),
          shown("shear y", values.shear_y, Uncertainty::shear_y, ComponentEnd::shear_y_low)};
}

std::vector<ShownValue> shown_forces(const PillarValues& values, const Skin& skin,
                                     const PressureUnit& unit) {
  const auto components = shown_components(values);
  if (values.has_pillars) return {components.begin(), components.end()};
  const double pressure = static_cast<double>(kpa_per_newton(skin)) / unit.kpa;
  return {components.front(),
          with_deviation("pressure", pressure * static_cast<double>(values.normal),
                         pressure * plane(values, Uncertainty::normal), unit.name)};
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
  if (!contact.friction) return "–";
  const bool bound = contact.friction_source == FrictionSource::at_least;
  return fmt::format("{}{:.2f}", bound ? "≥ " : "", *contact.friction);
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
          {"µ", "friction", "≥ 0.00", format_friction},
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
