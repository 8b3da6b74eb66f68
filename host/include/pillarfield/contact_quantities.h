#pragma once

#include <cstdint>
#include <optional>

#include "pillarfield/friction.h"

namespace pillarfield {

/// A place on the patch, mm: from its centre, x right and y up, as in scenes.
struct PatchPlace {
  double x_mm = 0;
  double y_mm = 0;
};

/// What is known of a contact's slip.
enum class SlipState : std::uint8_t {
  unknown,   ///< the friction is not known, or too much of the load is borne by ambiguous pillars
  sticking,  ///< pillars that bear at most a tenth of the load slip
  partial,   ///< some slip, some stick
  sliding,   ///< pillars that bear nine tenths or more slip
};

/// "unknown", "sticking", "partial", "sliding".
[[nodiscard]] const char* name_of(SlipState state);

/// What a contact exerts on the skin, and where (docs/contacts_found.md). Forces are sums over its
/// pillars, with the signs of ForceFieldView.
///
/// Sums are in double precision, in an order that the contact alone decides: the same bits with any
/// number of threads. A pillar's NaN or infinity counts as zero.
struct ContactQuantities {
  std::uint64_t pillars = 0;
  std::uint64_t ambiguous = 0;  ///< of these, pillars that readings alone leave open
  std::uint64_t resolved = 0;   ///< of these, such as the contact's friction resolved

  double shear_x_n = 0;
  double shear_y_n = 0;
  double normal_n = 0;
  /// Sum of normal times place over sum of normal; where that sum is not above zero, `centre`.
  PatchPlace centre_of_pressure;
  PatchPlace centre;  ///< mean place of the pillars
  /// Moment of the shear about the outward normal through the centre of pressure, counter-clockwise
  /// positive. The other two moments vanish there: that is what makes it the centre of pressure.
  double torque_nmm = 0;

  double area_mm2 = 0;  ///< pillars times pitch²
  double peak_n = 0;    ///< the largest normal force of a pillar
  PatchPlace peak;      ///< where; of equal ones the first row by row
  double mean_pressure_kpa = 0;

  /// The friction coefficient, where it was given, or where the standard deviation of the
  /// posterior's logarithm is at most 0.02 and the contact is no flat face that may stick
  /// (docs/derivations/contact.md, section 5). Unset elsewhere.
  std::optional<double> friction;
  std::optional<double> friction_deviation;  ///< its standard deviation; unset as friction
  FrictionSource friction_source = FrictionSource::prior;
  SlipState slip = SlipState::unknown;
  /// Of the normal force of the unambiguous pillars, the share on those whose shear / normal is
  /// 0.92 of the friction or more. Unset where the friction is not known, or no pillar is
  /// unambiguous.
  std::optional<double> slipping_share;
  /// 1 - |shear| / (friction normal) of the sums: what is left before the whole contact slides in a
  /// straight line. It says nothing of a spin, whose shear cancels. Unset without friction, or
  /// where nothing presses.
  std::optional<double> slip_margin;
};

/// The moment about another point in the plane of the skin, N mm; axes as in ForceFieldView with z
/// outwards.
struct Moment {
  double x_nmm = 0;
  double y_nmm = 0;
  double z_nmm = 0;
};

/// Moves the moment of a contact from its centre of pressure to `point`: M = r × F + torque, r from
/// `point` to the centre of pressure.
[[nodiscard]] Moment moment_about(const PatchPlace& point, const ContactQuantities& contact);

}  // namespace pillarfield
