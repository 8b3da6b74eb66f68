#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "pillarfield/calibration.h"
#include "pillarfield/friction.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// The algorithm that estimates forces from readings.
enum class Estimator : std::uint8_t {
  direct,  ///< linear least squares of each frame alone; reaches the Cramér–Rao bound in regions 1
           ///< and 2 (docs/derivations/direct_solve.md)
  paper,    ///< the paper's equations, for comparison (docs/derivations/paper_solve.md)
  contact,  ///< direct, then ambiguous pillars from the estimated friction of their contact
            ///< (docs/derivations/contact.md)
};

/// Default of SolverPlan::segment_point.
inline constexpr double kSegmentPoint = 0.875;

/// "direct", "paper" or "contact".
[[nodiscard]] const char* name_of(Estimator estimator);

/// The sensor and what to compute. Each member that is set or not empty adds its stage to the
/// kernel; an absent one costs nothing.
struct SolverPlan {
  Skin skin;  ///< set at least `rows`, `cols` and `counts_per_newton`
  SenselType sensel_type = SenselType::u8;
  Calibration calibration;  ///< empty planes: no correction
  /// Tolerance of the parity test V1 + V3 = V2 + V4, counts, >= 0: a pillar whose residual, or the
  /// surplus of whose inactive sensel, is larger gets status::kInconsistent. Unset: no test.
  std::optional<double> parity_tolerance_counts;
  /// Standard deviation of a raw reading from frame to frame, counts, >= 0, without the rounding of
  /// the converter. Used for sensels without a noise plane. Unset: unknown.
  std::optional<double> noise_counts;
  std::optional<Estimator> estimator;  ///< unset: see estimator_of()
  /// Position of the force that Estimator::direct reports on the segment of a pillar with two
  /// adjacent usable sensels: a fraction, (0, 1], of the largest normal force on it. In simulated
  /// contacts of friction 1.6 and 2.2 the true force lies at 0.94 and 0.85, and the RMS error is 6
  /// and 4 counts with 0.875, 25 and 19 counts with 0.5, the minimax choice
  /// (docs/derivations/direct_solve.md, section 5).
  double segment_point = kSegmentPoint;
  FrictionKnowledge friction;  ///< prior for Estimator::contact
  /// Fraction of its distance from the reading by which the tare of an untouched sensel moves after
  /// each frame, (0, 1]; see set_baseline(). Unset: the tare is fixed. A sensel is untouched if
  /// neither its pillar nor the eight around it have a usable or saturated sensel. Other tares move
  /// by what the untouched ones have in common (docs/derivations/sensor_effects.md, E11).
  std::optional<double> baseline_rate;
  /// Number of frames over which the update of the tare is spread, 1 to 1024: each frame updates
  /// every baseline_interval-th pillar row. The tare follows as fast as with 1 at a fraction of the
  /// cost.
  int baseline_interval = 1;
  /// Time, s, within which a followed tare takes in the rest that a touch leaves behind: what stays
  /// steady at a fifth of the touch or less (docs/derivations/sensor_effects.md, E13).
  double release_time_s = 1;
  /// Time from frame to frame, s, above zero; needed where calibration.effects.memory has creep.
  double frame_interval_s = 0.01;
  bool angles = false;       ///< also compute magnitude, theta and phi
  bool uncertainty = false;  ///< also compute the planes of Uncertainty; needs the noise of the
                             ///< sensels, and an estimator other than `paper`
  bool pressure = false;     ///< files of the forces hold the pressure too
};

/// The estimator of the plan. Unset, it is `contact` where the skin has pillars; sensels without
/// pillars have only `direct`.
[[nodiscard]] Estimator estimator_of(const SolverPlan& plan);

/// A user's settings of a plan. Settings that are unset leave what the frames, the scene and the
/// calibration say.
struct PlanSettings {
  std::optional<Pitch> sensel_pitch_mm;
  std::optional<SkinLayout> layout;
  std::optional<double> threshold_counts;
  std::optional<double> counts_per_newton;
  std::optional<double> full_scale_counts;
  std::optional<double> noise_counts;
  std::optional<double> baseline_time_s;  ///< of set_baseline()
  std::optional<double> release_time_s;
  std::optional<double> baseline_interval;
  std::optional<double> frame_interval_s;
  std::optional<double> parity_tolerance_counts;
  std::optional<double> friction;
  std::optional<double> friction_bound;
  std::vector<double> friction_prior;  ///< empty, or median and spread
  std::optional<bool> unrelated_frames;
  std::optional<Estimator> estimator;
  std::optional<bool> angles;
  std::optional<bool> uncertainty;
  std::optional<bool> pressure;
  bool everything = false;  ///< all outputs, the parity test and a followed baseline
};

/// Sets the members of the plan for which there are settings: all but `baseline_time_s` and
/// `everything`, which build_plan() applies.
void apply(const PlanSettings& settings, SolverPlan& plan);

/// Throws Error, naming `where`, if a number is out of range.
void check(const PlanSettings& settings, std::string_view where);

/// Throws Error, naming `where`, if a member is out of range or two members exclude each other.
void check(const SolverPlan& plan, std::string_view where);

/// Lets the tare follow drift with a time constant, s, above zero: sets baseline_rate, 1 −
/// exp(−frame_interval_s / time constant), and baseline_interval, for which a pillar row has its
/// turn a hundred times in a time constant, and forty in release_time_s. Set frame_interval_s and
/// release_time_s before (docs/derivations/sensor_effects.md, section 12).
void set_baseline(SolverPlan& plan, double time_constant_s);

/// Standard deviation of a reading as a force, N, for ContactOptions::noise_n: that of
/// noise_counts, of rounding and of ResidualError::offset_counts, over counts_per_newton. A quarter
/// of the threshold stands in for the first two if the plan has neither noise_counts nor a noise
/// plane.
[[nodiscard]] double reading_noise_n(const SolverPlan& plan);

/// The largest normal force that inactive sensels may hide below the threshold, N, for
/// ContactOptions::hidden_n (docs/derivations/segment.md, F1).
[[nodiscard]] double hidden_normal_n(const Skin& skin);

}  // namespace pillarfield
