#include "core/contact_measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr double kQuantum = ForceQuanta::kForceQuantum;

/// Bounds of SlipState, as shares of the load.
constexpr double kFew = 0.1;
constexpr double kMostOpen = 0.25;

/// Shear over normal force of a pillar that presses and whose readings determine it: in region 1
/// or 2. It may be doubtful which of the two: that moves the force by a threshold's worth at most.
std::optional<double> ratio_of(const PillarForce& pillar) {
  constexpr int kDoubtful = status::kFromNeighbours | status::kSaturated | status::kInconsistent;
  if (pillar.normal <= 0 || (pillar.status & kDoubtful) != 0) return std::nullopt;
  const Region region = region_of(pillar.status);
  if (region != Region::one && region != Region::two) return std::nullopt;
  const auto x = static_cast<double>(pillar.shear_x);
  const auto y = static_cast<double>(pillar.shear_y);
  return std::sqrt(x * x + y * y) / static_cast<double>(pillar.normal);
}

/// The largest ratio at which the pillar, sheared in its direction, would not be ambiguous:
/// 1 / min(|cos d|, |sin d|) with d from a diagonal.
double ceiling_of(const PillarForce& pillar) {
  const auto x = static_cast<double>(pillar.shear_x);
  const auto y = static_cast<double>(pillar.shear_y);
  const double least = std::min(std::abs(x + y), std::abs(y - x));
  return std::sqrt(2 * (x * x + y * y)) / least;
}

}  // namespace

ContactMeasure::ContactMeasure(const ForceFieldView& forces, double pillar_pitch_mm,
                               FrictionHistogram& scratch)
    : forces_(forces),
      pitch_mm_(pillar_pitch_mm),
      quanta_(std::uint64_t{forces.rows} * forces.cols),
      histogram_(scratch) {}

PillarForce ContactMeasure::pillar(std::uint32_t row, std::uint32_t col) const {
  const std::size_t place = std::size_t{row} * forces_.cols + col;
  return {quanta_.of(forces_.shear_x[place]),       quanta_.of(forces_.shear_y[place]),
          quanta_.of(forces_.normal[place]),        2 * std::int64_t{col} + 1 - forces_.cols,
          forces_.rows - 2 * std::int64_t{row} - 1, forces_.status[place]};
}

template <class Visit>
void ContactMeasure::visit(std::span<const ContactRun> runs, Visit visit_pillar) const {
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) visit_pillar(pillar(run.row, col));
  }
}

ContactSum ContactMeasure::sum(std::span<const ContactRun> runs) const {
  ContactSum total;
  visit(runs, [&](const PillarForce& force) { total.add(force); });
  return total;
}

std::optional<double> ContactMeasure::friction(std::span<const ContactRun> runs,
                                               std::int64_t peak) const {
  if (peak <= 0) return std::nullopt;
  histogram_.clear();
  visit(runs, [&](const PillarForce& force) {
    if (force.normal < peak / 4) return;
    const std::optional<double> ratio = ratio_of(force);
    if (!ratio) return;
    const double weight = FrictionHistogram::kMostWeight * static_cast<double>(force.normal) /
                          static_cast<double>(peak);
    histogram_.add(*ratio, static_cast<std::uint32_t>(weight), ceiling_of(force));
  });
  const std::optional<FrictionPlateau> plateau = histogram_.plateau();
  if (!plateau) return std::nullopt;
  return plateau->friction;
}

SlipSum ContactMeasure::slip(std::span<const ContactRun> runs, double friction) const {
  SlipSum total;
  visit(runs, [&](const PillarForce& force) {
    if (force.normal <= 0) return;
    const std::optional<double> ratio = ratio_of(force);
    if (!ratio) {
      total.open += force.normal;
    } else if (*ratio >= kWithinPlateau * friction) {
      total.slipping += force.normal;
    } else {
      total.sticking += force.normal;
    }
  });
  return total;
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

SlipState state_of(const SlipSum& slip) {
  const auto slipping = static_cast<double>(slip.slipping);
  const auto sticking = static_cast<double>(slip.sticking);
  const auto open = static_cast<double>(slip.open);
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
              const SlipSum& slip) {
  contact.friction = friction;
  contact.friction_source = source;
  contact.slip = state_of(slip);
  const auto known = static_cast<double>(slip.slipping + slip.sticking);
  if (known > 0) contact.slipping_share = static_cast<double>(slip.slipping) / known;
  if (contact.normal_n > 0) {
    const double shear_n =
        std::sqrt(contact.shear_x_n * contact.shear_x_n + contact.shear_y_n * contact.shear_y_n);
    contact.slip_margin = 1 - shear_n / (friction * contact.normal_n);
  }
}

}  // namespace pillarfield
