#include "viewer/app/panels/format_contact.h"

#include <fmt/format.h>

#include <cmath>

#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
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
  if (!contact.friction_deviation) return fmt::format("{:.2f}", *contact.friction);
  return fmt::format("{:.2f} ± {:.2f}", *contact.friction, *contact.friction_deviation);
}

}  // namespace

const std::array<ContactColumn, kContactColumns>& contact_columns() {
  static constexpr std::array<ContactColumn, kContactColumns> kColumns{{
      {"id", "constant while the contact is tracked", "0000"},
      {"normal", "normal force, N", "00000"},
      {"shear", "shear force, N", "00000"},
      {"µ", "friction and its standard deviation, if observed", "0.00 ± 0.00"},
      {"slip", "sticking, partial, sliding or unknown", "unknown"},
      {"ambiguous", "fraction of pillars / fraction of these resolved from the contact",
       "00 % / 00 %"},
      {"mean", "mean pressure, kPa", "00000"},
      {"area", "mm²", "00000"},
      {"peak", "largest normal force of a pillar, N", "0.000"},
  }};
  return kColumns;
}

std::array<std::string, kContactColumns> format_contact(const std::string& name,
                                                        const ContactQuantities& contact) {
  return {name,
          three_digits(contact.normal_n),
          three_digits(std::hypot(contact.shear_x_n, contact.shear_y_n)),
          format_friction(contact),
          name_of(contact.slip),
          format_ambiguous(contact),
          three_digits(contact.mean_pressure_kpa),
          three_digits(contact.area_mm2),
          three_digits(contact.peak_n)};
}

}  // namespace pillarfield::viewer
