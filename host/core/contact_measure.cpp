#include "core/contact_measure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/contact_ratios.h"

namespace pillarfield {
namespace {

constexpr double kQuantum = ForceQuanta::kForceQuantum;

/// Bounds of SlipState, as shares of the load.
constexpr double kFew = 0.1;
constexpr double kMostOpen = 0.25;

/// Fewer pillars cannot show a friction, and more of a contact need not be asked.
constexpr std::uint64_t kFewestForFriction = 8;
constexpr std::uint64_t kSamples = 500;

constexpr std::uint64_t kFewestRows = 8;

/// One of so many rows of a contact is asked for its friction.
std::uint64_t step_of(std::span<const ContactRun> runs, std::uint64_t pillars) {
  const std::uint64_t rows = runs.back().row - runs.front().row + 1;
  const std::uint64_t enough = (pillars + kSamples - 1) / kSamples;
  return std::min(enough, std::max<std::uint64_t>(rows / kFewestRows, 1));
}

}  // namespace

std::uint64_t pillars_of(std::span<const ContactRun> runs) {
  std::uint64_t pillars = 0;
  for (const ContactRun& run : runs) pillars += run.end - run.first;
  return pillars;
}

ContactMeasure::ContactMeasure(const ForceFieldView& forces, double pillar_pitch_mm)
    : forces_(forces), pitch_mm_(pillar_pitch_mm) {}

std::optional<double> ContactMeasure::friction(std::span<const ContactRun> runs,
                                               FrictionHistogram& scratch) const {
  const std::uint64_t pillars = pillars_of(runs);
  if (pillars < kFewestForFriction) return std::nullopt;
  const std::uint64_t step = step_of(runs, pillars);
  std::vector<ContactRun> asked;
  for (const ContactRun& run : runs) {
    if ((run.row - runs.front().row) % step == step / 2) asked.push_back(run);
  }
  scratch.clear();
  add_ratios(forces_, asked, peak_of(forces_, asked), scratch);
  const std::optional<FrictionPlateau> plateau = scratch.plateau();
  if (!plateau) return std::nullopt;
  return plateau->friction;
}

ContactTotals ContactMeasure::totals(std::span<const ContactRun> runs,
                                     std::optional<double> friction) const {
  if (friction) friction = kWithinPlateau * *friction;
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

void set_slip(ContactQuantities& contact, double friction, FrictionSource source,
              const PressingSum& slip) {
  contact.friction = friction;
  contact.friction_source = source;
  contact.slip = state_of(slip);
  const auto known = static_cast<double>(slip.known);
  if (known > 0) contact.slipping_share = static_cast<double>(slip.slipping) / known;
  if (contact.normal_n > 0) {
    const double shear_n =
        std::sqrt(contact.shear_x_n * contact.shear_x_n + contact.shear_y_n * contact.shear_y_n);
    contact.slip_margin = 1 - shear_n / (friction * contact.normal_n);
  }
}

}  // namespace pillarfield
