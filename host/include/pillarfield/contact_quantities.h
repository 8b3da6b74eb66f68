#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "pillarfield/friction.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// A point on the skin, mm from the centre of the patch: x right, y up.
struct PatchPlace {
  double x_mm = 0;
  double y_mm = 0;
};

/// The slip state of a contact.
enum class SlipState : std::uint8_t {
  unknown,   ///< friction, noise and ambiguous pillars leave it open
  sticking,  ///< slipping pillars carry at most a tenth of the load
  partial,   ///< neither sticking nor sliding
  sliding,   ///< slipping pillars carry at least nine tenths
};

/// "unknown", "sticking", "partial", "sliding".
[[nodiscard]] const char* name_of(SlipState state);

/// Force on the skin and its moment about the origin, in the body's frame (surface.h).
struct Wrench {
  Vector3 force_n;
  Vector3 moment_nmm;
};

/// Standard deviations of a contact's sums by what was filled in for its unseen elements.
struct UnseenDeviations {
  double shear_x_n = 0;
  double shear_y_n = 0;
  double normal_n = 0;
  PatchPlace centre_of_pressure;
  double torque_nmm = 0;
};

/// Time until a contact slides as a whole, if its load goes on to change at the present rate.
struct SlipForecast {
  static constexpr std::array<double, 3> kWithinS = {0.1, 0.3, 1};
  std::optional<double> time_s;  ///< unset unless the load surely rises, and while it may swing
  /// Its 95 % interval; unset likewise, but low_s is set in a swing, and 0 near the friction.
  std::optional<double> low_s;
  std::optional<double> high_s;
  std::array<double, 3> probability{};  ///< of slip within kWithinS
};

/// Force, torque, place, friction and slip of a contact (docs/contacts_found.md). Forces are sums
/// over its pillars, with the signs of ForceFieldView. Without pillars its elements are sensels:
/// then shear, torque, friction and slip do not exist, and stay zero and unset.
///
/// Sums are in double precision, in an order that the contact alone determines, so they do not
/// depend on the number of threads. NaN and infinity count as zero.
struct ContactQuantities {
  std::uint64_t pillars = 0;
  std::uint64_t ambiguous = 0;  ///< of these, ambiguous by their readings alone
  std::uint64_t resolved = 0;   ///< of the ambiguous, resolved by friction

  bool has_shear = true;  ///< false without pillars: shear, torque, friction, slip do not exist
  double shear_x_n = 0;
  double shear_y_n = 0;
  double normal_n = 0;
  /// Mean position weighted by normal force; `centre` if normal_n is not above zero.
  PatchPlace centre_of_pressure;
  PatchPlace centre;  ///< mean position of the pillars
  /// Moment of the shear about the outward normal through the centre of pressure, counter-clockwise
  /// positive. The moments about the other two axes are zero there.
  double torque_nmm = 0;

  /// Share of the area that is unseen, 0 to 1: elements under the contact whose sensels are missing
  /// or masked. Sums, centre of pressure and area hold what their neighbours let expect there.
  double unseen = 0;
  std::optional<UnseenDeviations> unseen_deviations;  ///< unset where nothing is unseen

  double area_mm2 = 0;           ///< pillars and unseen elements times the area of one
  double peak_n = 0;             ///< the largest normal force of a pillar
  PatchPlace peak;               ///< its position; the first, row by row, if several are equal
  double mean_pressure_kpa = 0;  ///< normal_n over area_mm2
  /// The normal force of the most loaded element over its area; zero without elements.
  [[nodiscard]] double peak_pressure_kpa() const {
    const double seen_mm2 = (1 - unseen) * area_mm2;
    return seen_mm2 > 0 ? 1000 * peak_n * static_cast<double>(pillars) / seen_mm2 : 0;
  }
  /// Sum over the pillars on their poses; set with ContactOptions::surface.
  std::optional<Wrench> wrench;

  /// Friction coefficient: ratio of shear to normal force at which the contact slides as a whole.
  /// Set if it was given, or once it stayed while the load rose (docs/derivations/contact.md,
  /// section 5); with the source at_least a lower bound, which holds in 19 of 20 cases.
  std::optional<double> friction;
  std::optional<double> friction_deviation;  ///< its standard deviation; unset for a lower bound
  FrictionSource friction_source = FrictionSource::prior;
  SlipState slip = SlipState::unknown;
  /// Slipping fraction of the normal force, [0, 1]: of the unambiguous pillars, the part carried by
  /// those with shear / normal >= 0.92 friction. Unset without such pillars, and without a friction
  /// of at most 20 % deviation.
  std::optional<double> slipping_share;
  /// Slip margin, 1 − |shear| / (friction · normal) of the sums: the reserve before the whole
  /// contact slides in a straight line. A spin, whose shear cancels, does not lower it. Unset
  /// without friction_deviation, or if normal_n is not above zero.
  std::optional<double> slip_margin;
  /// Set with friction_deviation: of a contact that slides or spins, time 0 and probability 1; else
  /// from the fourth frame of a track on.
  std::optional<SlipForecast> slip_forecast;
};

/// A moment about a point of the skin: x right, y up, z outwards.
struct Moment {
  double x_nmm = 0;
  double y_nmm = 0;
  double z_nmm = 0;
};

/// The moment of a contact's force about `point`: M = r × F + torque, r from `point` to the centre
/// of pressure.
[[nodiscard]] Moment moment_about(const PatchPlace& point, const ContactQuantities& contact);

}  // namespace pillarfield
