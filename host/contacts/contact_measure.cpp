#include "contacts/contact_measure.h"

#include <cmath>

#include "contacts/estimator/contact_parameters.h"

namespace pillarfield {
namespace {

/// Bounds of SlipState, as fractions of the normal force.
constexpr double kFew = 0.1;

/// Largest standard deviation of the friction's logarithm at which its pillars tell slip.
constexpr double kMostSpread = 0.2;

/// A pillar slips if shear / normal is at least this fraction of the friction coefficient.
constexpr double kSlipRatio = 0.92;

/// Standard deviation of a ratio, in units of reading noise over normal force (direct_solve.md).
constexpr double kNoiseOfRatio = 1.6;

/// Lower bound of the friction of a contact's roughest part over that of the whole.
constexpr double kRoughest = 1 / ContactParameters{}.bound_factor;

bool is_well_known(const ContactFriction& friction) {
  return friction.source != FrictionSource::prior && friction.source != FrictionSource::at_least &&
         friction.spread <= kMostSpread;
}

SlipState state_of(double slipping) {
  if (slipping <= kFew) return SlipState::sticking;
  return slipping >= 1 - kFew ? SlipState::sliding : SlipState::partial;
}

/// The state on which the least and the largest share that may slip agree. Without a well known
/// friction only the largest is known.
SlipState state_of(const ContactSum& sum, bool well_known) {
  if (!(sum.pressing > 0)) return SlipState::unknown;
  const SlipState most = state_of(1 - sum.sticking / sum.pressing);
  const bool agree =
      most == (well_known ? state_of(sum.reaching / sum.pressing) : SlipState::sticking);
  return agree ? most : SlipState::unknown;
}

}  // namespace

ContactQuantities quantities_of(const ContactSum& sum, const Pitch& pitch_mm, bool has_shear) {
  ContactQuantities contact;
  contact.has_shear = has_shear;
  if (sum.pillars == 0) return contact;
  const double half_x_mm = pitch_mm.col_mm / 2;
  const double half_y_mm = pitch_mm.row_mm / 2;
  const auto pillars = static_cast<double>(sum.pillars);
  contact.pillars = static_cast<std::uint64_t>(sum.pillars);
  contact.ambiguous = static_cast<std::uint64_t>(sum.ambiguous);
  contact.resolved = static_cast<std::uint64_t>(sum.resolved);
  contact.shear_x_n = sum.shear_x;
  contact.shear_y_n = sum.shear_y;
  contact.normal_n = sum.normal;
  contact.centre = {static_cast<double>(sum.x) / pillars * half_x_mm,
                    static_cast<double>(sum.y) / pillars * half_y_mm};
  contact.centre_of_pressure = contact.centre;
  if (sum.normal > 0) {
    contact.centre_of_pressure = {sum.normal_x / sum.normal * half_x_mm,
                                  sum.normal_y / sum.normal * half_y_mm};
  }
  const double about_origin_nmm = sum.shear_y_x * half_x_mm - sum.shear_x_y * half_y_mm;
  contact.torque_nmm = about_origin_nmm - (contact.centre_of_pressure.x_mm * contact.shear_y_n -
                                           contact.centre_of_pressure.y_mm * contact.shear_x_n);
  contact.area_mm2 = pillars * pitch_mm.area_mm2();
  contact.peak_n = sum.peak;
  contact.peak = {static_cast<double>(sum.peak_x) * half_x_mm,
                  static_cast<double>(sum.peak_y) * half_y_mm};
  contact.mean_pressure_kpa = 1000 * contact.normal_n / contact.area_mm2;
  return contact;
}

SlipTest slip_test(const ContactFriction& friction, double noise_n) {
  return {kSlipRatio * (is_well_known(friction) ? friction.median : kRoughest * friction.least),
          kNoiseOfRatio * noise_n};
}

void set_slip(ContactQuantities& contact, const ContactFriction& friction, const ContactSum& sum) {
  contact.friction_source = friction.source;
  const bool well_known = is_well_known(friction);
  contact.slip = state_of(sum, well_known);
  if (friction.source == FrictionSource::at_least) contact.friction = friction.least;
  if (friction.source == FrictionSource::prior || contact.friction) return;
  contact.friction = friction.median;
  contact.friction_deviation = friction.median * friction.spread;
  if (well_known && sum.determined > 0) contact.slipping_share = sum.slipping / sum.determined;
  if (contact.normal_n > 0) {
    const double shear_n =
        std::sqrt(contact.shear_x_n * contact.shear_x_n + contact.shear_y_n * contact.shear_y_n);
    contact.slip_margin = 1 - shear_n / (friction.median * contact.normal_n);
  }
}

}  // namespace pillarfield
