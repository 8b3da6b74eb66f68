#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/scene.h"
#include "pillarfield/solver_plan.h"

/// How well the forces of ambiguous pillars are estimated: recordings with their truth, and the
/// errors of estimates. contact_study_histories.h and
/// contact_study_scenes.h make the recordings.
namespace pillarfield::contact_study {

/// Frames of one sensor and the forces that caused them.
struct Recording {
  std::string name;
  double friction = 1;
  SolverPlan plan;  ///< of this sensor: direct, with uncertainty
  std::vector<FrameBuffer> frames;
  std::vector<ForceField> truth;  ///< one for each frame
};

/// What the sensor of a scene reads of these forces, with the noise of the scene's seed. The
/// scene's contacts and bodies play no part.
[[nodiscard]] Recording read_forces(Scene scene, std::vector<ForceField> truth);

/// The largest reading of a flawless sensor at one count per newton, counts.
[[nodiscard]] double largest_reading(std::span<const ForceField> truth);

/// The forces of all frames, in their order, by a plan of the recording's sensor.
[[nodiscard]] std::vector<ForceField> solve(const Recording& recording, const SolverPlan& plan);

/// What `Estimator::contact` has learnt of a contact's friction up to a frame.
struct FrictionEstimate {
  std::uint64_t pillars = 0;  ///< of the contact
  double median = 0;
  double spread = 0;  ///< standard deviation of its logarithm
  /// Sum of the estimated shears over the sum of median times normal force: near 1 where the whole
  /// contact slips.
  double used = 0;
  /// Share of its pillars that truly bear 0.9 or more of the shear that friction allows.
  double slipping = 0;
};

/// One entry for each contact of each frame, with the default prior.
[[nodiscard]] std::vector<FrictionEstimate> friction_estimates(const Recording& recording);

/// All forces that the readings of a pillar of region 3 leave: normal forces in [0, normal_high],
/// and shear of which one component is fixed and the other changes with the normal force
/// (docs/derivations/direct_solve.md).
struct Segment {
  double fixed = 0;        ///< N
  double moving = 0;       ///< N, at no normal force
  double rate = 0;         ///< of the moving one by the normal force, ±√2
  double normal_high = 0;  ///< N
  bool moves_in_y = true;

  [[nodiscard]] double shear_x(double normal) const;
  [[nodiscard]] double shear_y(double normal) const;
  /// The normal force at which the force is nearest to one with these components, N.
  [[nodiscard]] double nearest(double shear_x, double shear_y, double normal) const;
};

/// The segment of pillar `index` of a direct solve, which is in region 3.
[[nodiscard]] Segment segment_of(const ForceField& direct, std::size_t index, double segment_point);

/// A statement about one component of a pillar's force that is to hold for 95 % of pillars.
struct Interval {
  const char* name;
  /// Low-to-high intervals, which leave noise out, are widened by 1.96 times `noise_n`, N, in the
  /// force; 0: as they are stated.
  bool (*holds)(const ForceField& solved, const ForceField& truth, std::size_t pillar,
                double noise_n);
};
inline constexpr std::size_t kIntervals = 6;
inline constexpr std::size_t kFirstEnds = 3;  ///< from here on intervals are low to high

/// What lies between the ends of the three components, as component_ends() has them of estimates
/// that are not direct ones, and between those of magnitude and angles.
[[nodiscard]] const std::array<Interval, kIntervals>& intervals();

/// Errors over the pillars of region 3, and of the total normal force of frames.
struct Score {
  std::size_t loaded = 0;     ///< pillars with a usable sensel
  std::size_t ambiguous = 0;  ///< of these in region 3 by their status, and truly loaded
  double squares = 0;         ///< sum of |error|² of the force vector, counts²
  std::array<std::size_t, kIntervals> held{};             ///< intervals that hold the truth
  std::array<std::size_t, kIntervals> held_with_noise{};  ///< where widened by that of a reading
  std::size_t frames = 0;                                 ///< that are truly loaded
  double total_errors = 0;                                ///< sum over frames of the relative error
  double total_squares = 0;                               ///< and of its square

  [[nodiscard]] double rms_counts() const;
  [[nodiscard]] double coverage(std::size_t interval) const;  ///< 1 where nothing is ambiguous
  [[nodiscard]] double total_bias() const;
  [[nodiscard]] double total_rms() const;
  Score& operator+=(const Score& other);
};

/// Scores estimates of a recording, which must outlive it.
class Evaluation {
 public:
  explicit Evaluation(const Recording& recording);

  [[nodiscard]] const std::vector<ForceField>& direct() const { return direct_; }
  /// The pillars of region 3 of a frame.
  [[nodiscard]] const std::vector<std::size_t>& ambiguous(std::size_t frame) const {
    return ambiguous_[frame];
  }
  /// The force on the line of each segment that is nearest to the truth: the error that noise
  /// leaves to whatever explains the readings.
  [[nodiscard]] std::vector<ForceField> nearest() const;
  [[nodiscard]] Score score(const std::vector<ForceField>& solved) const;

 private:
  const Recording& recording_;
  std::vector<ForceField> direct_;
  std::vector<std::vector<std::size_t>> ambiguous_;
};

/// Calls `work(i)` for 0 <= i < count on all cores, and throws what one of the calls threw.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace pillarfield::contact_study
