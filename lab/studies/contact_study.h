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

/// Accuracy of the estimated forces of ambiguous pillars: recordings with their truth, and errors
/// of estimates. contact_study_histories.h makes the recordings.
namespace pillarfield::contact_study {

/// Frames of one sensor and the forces that caused them.
struct Recording {
  std::string name;
  double friction = 1;
  SolverPlan plan;  ///< estimator `direct`, with uncertainty
  std::vector<FrameBuffer> frames;
  std::vector<ForceField> truth;  ///< one per frame
};

/// The readings of a scene's sensor under the forces `truth`, with the scene's noise. Ignores the
/// scene's contacts and bodies.
[[nodiscard]] Recording read_forces(Scene scene, std::vector<ForceField> truth);

/// Largest reading of a flawless sensor of one count per newton, counts.
[[nodiscard]] double largest_reading(std::span<const ForceField> truth);

/// Solves all frames in order by a plan for the recording's sensor.
[[nodiscard]] std::vector<ForceField> solve(const Recording& recording, const SolverPlan& plan);

/// The friction of a contact as `Estimator::contact` estimates it up to a frame.
struct FrictionEstimate {
  std::uint64_t pillars = 0;  ///< pillars of the contact
  double median = 0;
  double spread = 0;  ///< standard deviation of the logarithm
  /// Sum of estimated shears over the sum of median times normal force: near 1 in full sliding.
  double used = 0;
  /// Fraction of pillars whose true shear is at least 0.9 µ times the normal force.
  double slipping = 0;
};

/// One estimate per contact and frame, from the default prior.
[[nodiscard]] std::vector<FrictionEstimate> friction_estimates(const Recording& recording);

/// Feasible segment of a region 3 pillar: normal force in [0, normal_high], one shear component
/// fixed, the other linear in the normal force (docs/derivations/direct_solve.md).
struct Segment {
  double fixed = 0;        ///< N
  double moving = 0;       ///< N, at zero normal force
  double rate = 0;         ///< derivative of `moving` by the normal force, ±√2
  double normal_high = 0;  ///< N
  bool moves_in_y = true;

  [[nodiscard]] double shear_x(double normal) const;
  [[nodiscard]] double shear_y(double normal) const;
  /// The normal force of the point of the segment's line nearest to a force, N.
  [[nodiscard]] double nearest(double shear_x, double shear_y, double normal) const;
};

/// The segment of pillar `index`, in region 3, of a direct solve.
[[nodiscard]] Segment segment_of(const ForceField& direct, std::size_t index, double segment_point);

/// A stated 95 % interval of one quantity of a pillar's force.
struct Interval {
  const char* name;
  /// Whether the interval holds the truth. Low-to-high intervals exclude noise: they are widened by
  /// 1.96 times `noise_n`, N.
  bool (*holds)(const ForceField& solved, const ForceField& truth, std::size_t pillar,
                double noise_n);
};
inline constexpr std::size_t kIntervals = 6;
inline constexpr std::size_t kFirstEnds = 3;  ///< first low-to-high interval

/// Intervals of the three components (component_ends()), then of magnitude and angles.
[[nodiscard]] const std::array<Interval, kIntervals>& intervals();

/// Errors over the pillars of region 3, and of the total normal force of frames.
struct Score {
  std::size_t loaded = 0;                      ///< pillars with a usable sensel
  std::size_t ambiguous = 0;                   ///< loaded region 3 pillars with a true load
  double squares = 0;                          ///< sum of |error|² of the force vector, counts²
  std::array<std::size_t, kIntervals> held{};  ///< intervals that hold the truth
  std::array<std::size_t, kIntervals> held_with_noise{};  ///< the same, widened by noise
  std::size_t frames = 0;                                 ///< frames with a true load
  double total_errors = 0;                                ///< sum of relative errors of the frames
  double total_squares = 0;                               ///< sum of their squares

  [[nodiscard]] double rms_counts() const;
  [[nodiscard]] double coverage(std::size_t interval) const;  ///< 1 if no pillar is ambiguous
  [[nodiscard]] double total_bias() const;
  [[nodiscard]] double total_rms() const;
  Score& operator+=(const Score& other);
};

/// Scores estimates of a recording, which must outlive the object.
class Evaluation {
 public:
  explicit Evaluation(const Recording& recording);

  [[nodiscard]] const std::vector<ForceField>& direct() const { return direct_; }
  /// The loaded region 3 pillars of a frame.
  [[nodiscard]] const std::vector<std::size_t>& ambiguous(std::size_t frame) const {
    return ambiguous_[frame];
  }
  /// The points of the segments' lines nearest to the truth: their error is the least error of any
  /// estimate that explains the readings.
  [[nodiscard]] std::vector<ForceField> nearest() const;
  [[nodiscard]] Score score(const std::vector<ForceField>& solved) const;

 private:
  const Recording& recording_;
  std::vector<ForceField> direct_;
  std::vector<std::vector<std::size_t>> ambiguous_;
};

/// Calls `work(i)` for 0 <= i < count on all cores. Rethrows an exception of a call.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace pillarfield::contact_study
