#include "contacts/contact_measure.h"

#include <cmath>

namespace pillarfield {
namespace {

constexpr double kQuantum = ForceQuanta::kForceQuantum;

/// Bounds of SlipState, as shares of the load.
constexpr double kFew = 0.1;
constexpr double kMostOpen = 0.25;

/// From this share of the friction's ratio on a pillar slips.
constexpr double kSlipRatio = 0.92;

}  // namespace

std::uint64_t pillars_of(std::span<const ContactRun> runs) {
  std::uint64_t pillars = 0;
  for (const ContactRun& run : runs) pillars += run.end - run.first;
  return pillars;
}

ContactMeasure::ContactMeasure(const ForceFieldView& forces, double pillar_pitch_mm)
    : forces_(forces), pitch_mm_(pillar_pitch_mm) {}

ContactTotals ContactMeasure::totals(std::span<const ContactRun> runs,
                                     std::optional<double> friction) const {
  if (friction) friction = kSlipRatio * *friction;
  return totals_of(forces_, runs, friction);
}

ContactQuantities ContactMeasure::quantities(const ContactSum& sum) const {
  ContactQuantities contact;
  if (sum.pillars == 0) return contact;
  const double half_pitch_mm = pitch_mm_ / 2;
  const auto pillars = static_cast<double>(sum.pillars);
  contact.pillars = static_cast<std::uint64_t>(sum.pillars);
  contact.ambiguous = static_cast<std::uint64_t>(sum.ambiguous);
  contact.resolved = static_cast<std::uint64_t>(sum.resolved);
  contact.shear_x_n = static_cast<double>(sum.shear_x) * kQuantum;
  contact.shear_y_n = static_cast<double>(sum.shear_y) * kQuantum;
  contact.normal_n = static_cast<double>(sum.normal) * kQuantum;
  contact.centre = {static_cast<double>(sum.x) / pillars * half_pitch_mm,
                    static_cast<double>(sum.y) / pillars * half_pitch_mm};
  contact.centre_of_pressure = contact.centre;
  if (sum.normal > 0) {
    const auto normal = static_cast<double>(sum.normal);
    contact.centre_of_pressure = {sum.normal_x.value() / normal * half_pitch_mm,
                                  sum.normal_y.value() / normal * half_pitch_mm};
  }
  const double about_origin_nmm =
      (sum.shear_y_x.value() - sum.shear_x_y.value()) * kQuantum * half_pitch_mm;
  contact.torque_nmm = about_origin_nmm - (contact.centre_of_pressure.x_mm * contact.shear_y_n -
                                           contact.centre_of_pressure.y_mm * contact.shear_x_n);
  contact.area_mm2 = pillars * pitch_mm_ * pitch_mm_;
  contact.peak_n = static_cast<double>(sum.peak) * kQuantum;
  contact.peak = {static_cast<double>(sum.peak_x) * half_pitch_mm,
                  static_cast<double>(sum.peak_y) * half_pitch_mm};
  contact.mean_pressure_kpa = 1000 * contact.normal_n / contact.area_mm2;
  return contact;
}

namespace {

SlipState state_of(const PressingSum& slip) {
  const auto slipping = static_cast<double>(slip.slipping);
  const auto sticking = static_cast<double>(slip.known - slip.slipping);
  const auto open = static_cast<double>(slip.pressing - slip.known);
  const double all = slipping + sticking + open;
  if (all == 0 || open == all) return SlipState::unknown;
  if (slipping + open <= kFew * all) return SlipState::sticking;
  if (sticking <= kFew * (slipping + sticking) && open <= kMostOpen * all) {
    return SlipState::sliding;
  }
  const bool both = slipping > kFew * all && sticking > kFew * all;
  return both ? SlipState::partial : SlipState::unknown;
}

}  // namespace

std::optional<double> known_friction(const ContactFriction& friction) {
  if (friction.source == FrictionSource::prior) return std::nullopt;
  return friction.median;
}

void set_slip(ContactQuantities& contact, const ContactFriction& friction,
              const PressingSum& slip) {
  contact.friction_source = friction.source;
  if (friction.source == FrictionSource::prior) return;
  contact.friction = friction.median;
  contact.friction_deviation = friction.median * friction.spread;
  contact.slip = state_of(slip);
  const auto known = static_cast<double>(slip.known);
  if (known > 0) contact.slipping_share = static_cast<double>(slip.slipping) / known;
  if (contact.normal_n > 0) {
    const double shear_n =
        std::sqrt(contact.shear_x_n * contact.shear_x_n + contact.shear_y_n * contact.shear_y_n);
    contact.slip_margin = 1 - shear_n / (friction.median * contact.normal_n);
  }
}

}  // namespace pillarfield
