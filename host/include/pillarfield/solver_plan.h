#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "pillarfield/calibration.h"
#include "pillarfield/friction.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// How forces are estimated from readings.
enum class Estimator : std::uint8_t {
  direct,   ///< linear, on the Cramér–Rao bound in regions 1 and 2
            ///< (docs/derivations/direct_solve.md)
  paper,    ///< the paper's equations, for comparison (docs/derivations/paper_solve.md)
  contact,  ///< direct, then ambiguous pillars by what is believed of their contact's friction
            ///< (docs/derivations/contact.md)
};

/// See SolverPlan::segment_point.
inline constexpr double kSegmentPoint = 0.875;

/// "direct", "paper" or "contact".
[[nodiscard]] const char* name_of(Estimator estimator);

/// What is computed, and from which sensor. Each member that is set or not empty adds its
/// stage to the kernel; what is not named costs nothing.
struct SolverPlan {
  Skin skin;
  SenselType sensel_type = SenselType::u8;
  Calibration calibration;
  /// Largest parity residual, and largest surplus of a lifted sensel, that the status byte passes
  /// as consistent, in counts; unset: not tested.
  std::optional<double> parity_tolerance_counts;
  /// Standard deviation of a raw reading over frames, counts, converter's rounding apart. Used
  /// where the calibration has no noise plane of its own. Unset without one: noise is not known.
  std::optional<double> noise_counts;
  Estimator estimator = Estimator::direct;
  /// Where `direct` puts the force of a pillar with two adjacent usable sensels, as a fraction of
  /// the largest normal force that its readings allow, (0, 1]. In simulated contacts at
  /// friction 1.6 and 2.2 the true force lies at 0.94 and 0.85 of it, and the RMS error is 6 and 4
  /// counts at 0.875, 25 and 19 at 0.5: the middle, whose largest error is the least
  /// (docs/derivations/direct_solve.md, section 5).
  double segment_point = kSegmentPoint;
  FrictionKnowledge friction;  ///< for `Estimator::contact`, and of tracked contacts
  /// Share of its distance from the reading that the tare of an untouched sensel takes over after
  /// each frame, (0, 1]; unset: the tare stays. Untouched is a sensel whose pillar and the eight
  /// around it have no usable and no saturated sensel in that frame.
  std::optional<double> baseline_rate;
  /// Frames from one turn of a pillar row to the next, 1 to 1024: after each frame the tare follows
  /// in one row of so many, by what that many frames would have made of baseline_rate, and at that
  /// share of the cost.
  int baseline_interval = 1;
  bool angles = false;       ///< also magnitude, theta and phi
  bool uncertainty = false;  ///< also the planes of Uncertainty; needs the noise, not for `paper`
};

/// Throws Error, its place being `where`, when a member of `plan` is out of its range or two do not
/// go together.
void check(const SolverPlan& plan, std::string_view where);

/// The baseline_rate with which a tare follows a drift with a time constant, both in seconds and
/// above zero: 1 − exp(−interval / time constant).
[[nodiscard]] double baseline_rate(double time_constant_s, double frame_interval_s);

/// What the tare takes over when its pillar row has its turn: 1 − (1 − baseline_rate)^interval.
/// Zero where the tare stays.
[[nodiscard]] double baseline_turn_rate(const SolverPlan& plan);

/// Standard deviation of a raw reading of sensels without a noise plane, counts: that of the plan,
/// and of rounding to whole counts, 1/√12, where the sensel type has no fractions.
[[nodiscard]] double reading_noise(const SolverPlan& plan);

/// The same as a force, over the counts per newton, N; where the noise is not known, a quarter of
/// the threshold is taken for it.
[[nodiscard]] double reading_noise_n(const SolverPlan& plan);

/// The normal force that inactive sensels may hide below the threshold, N (docs/derivations/
/// segment.md, F1).
[[nodiscard]] double hidden_normal_n(const Skin& skin);

/// By how many counts noise may shift what parity leaves for a silent sensel, five standard
/// deviations: what direct_status takes as doubt. Zero where the noise is not known. One number for
/// all pillars, by the root mean square of the noise of the sensels and with gains taken as 1: in a
/// pillar whose gains are all g it is 5 / g deviations instead, 4 to 6 of them where g is 0.83 to
/// 1.25.
[[nodiscard]] double region_doubt(const SolverPlan& plan);

/// The same of sensels that all have this standard deviation, counts.
[[nodiscard]] double region_doubt(double noise_counts);

}  // namespace pillarfield
