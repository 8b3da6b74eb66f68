#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "field_contacts.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"

/// How well ambiguous pillars are resolved by their contact, on contacts of closed form: scenes,
/// ways to resolve, and how wrong each is.
namespace pillarfield::field_study {

/// A contact at a friction, seen through noise.
struct Scene {
  std::string contact_name;  ///< "sphere 30, partial slip 0.7 at 94°"
  FieldContact contact;
  double friction = 1;
  double noise_counts = 0.5;  ///< normal, standard deviation; the threshold is four times that
  std::uint64_t seed = 1;
  std::shared_ptr<const PillarLoads> loads;  ///< those of the contact, from integrate()

  [[nodiscard]] std::string name() const;  ///< with friction and noise
  [[nodiscard]] Family family() const { return family_of(contact.body.shape); }
  [[nodiscard]] Motion motion() const { return contact.drive.motion; }
};

/// Scenes by which the estimator was tuned, and those that judge it. They share no contact, no
/// friction, no direction and no seed; shapes that only the latter have are ellipse, merged
/// spheres, truncated cone, rounded punch. Only scenes whose name contains `filter`. Their loads
/// are not there yet.
[[nodiscard]] std::vector<Scene> tuning(std::string_view filter = {});
[[nodiscard]] std::vector<Scene> judging(std::string_view filter = {});

/// Scenes drawn at random, which tune as well: shapes, sizes, loads, motions, directions, frictions
/// and noises. Their shapes are those of tuning(), and the blunt body.
[[nodiscard]] std::vector<Scene> drawn(std::size_t count, std::string_view filter = {});

/// Adds the loads to scenes of one set, each contact integrated once; 4 s for all of them.
void integrate(std::vector<Scene>& scenes);

/// How wrong the forces of ambiguous pillars are; of the pillars in region 3 by their usable bits.
struct Score {
  std::size_t loaded = 0;    ///< pillars with a usable sensel
  std::size_t open = 0;      ///< of which region 3
  std::size_t resolved = 0;  ///< of these with bit 7
  std::size_t covered = 0;   ///< of these with the true normal force in the stated 95 % band
  std::size_t resolved_covered = 0;
  std::size_t touched = 0;  ///< pillars of regions 1 and 2 that differ from the direct solve
  double squares = 0;       ///< sum of |error|², counts²

  [[nodiscard]] double rms_counts() const;
  [[nodiscard]] double coverage() const;  ///< share; 1 where nothing is open
  Score& operator+=(const Score& other);
};

/// All forces that the readings of a pillar of region 3 leave: normal forces in [0, normal_high],
/// and shear of which one component is fixed and the other changes with the normal force.
struct Segment {
  double fixed = 0;        ///< N
  double moving = 0;       ///< N, at no normal force
  double rate = 0;         ///< of the moving one by the normal force, ±√2
  double normal_high = 0;  ///< N
  bool moves_in_y = true;

  [[nodiscard]] double shear_x(double normal) const;
  [[nodiscard]] double shear_y(double normal) const;
  /// The normal force at which the force's θ is the middle of what it may be.
  [[nodiscard]] double theta_midpoint() const;
  /// The normal force at which the force is nearest to one with these components, N.
  [[nodiscard]] double nearest(double shear_x, double shear_y, double normal) const;
};

/// The segment of pillar `index` of a direct solve, which is in region 3.
[[nodiscard]] Segment segment_of(const ForceField& direct, std::size_t index);

/// The frames of a scene that has its loads, with their truth.
class Observed {
 public:
  explicit Observed(const Scene& scene);

  [[nodiscard]] const SolverPlan& plan() const { return plan_; }  ///< direct, with uncertainty
  [[nodiscard]] const FrameBuffer& frame() const { return frame_; }
  [[nodiscard]] const ForceField& truth() const { return truth_; }
  [[nodiscard]] const ForceField& direct() const { return direct_; }
  [[nodiscard]] const std::vector<std::size_t>& open() const { return open_; }  ///< of region 3

  /// `count` frames, the last of which is frame(): the shear grows evenly from nothing, the
  /// pressure stays.
  [[nodiscard]] std::vector<FrameBuffer> frames(int count) const;

  [[nodiscard]] ForceField theta_midpoint() const;  ///< the paper's answer for region 3
  /// The force on each segment's line that is nearest to the truth: noise leaves that much to
  /// whatever explains the readings.
  [[nodiscard]] ForceField nearest() const;
  [[nodiscard]] Score score(const ForceField& solved) const;

 private:
  [[nodiscard]] FrameBuffer read(double share, std::uint64_t index) const;
  [[nodiscard]] ForceField with_normals(
      const std::function<double(const Segment&, std::size_t)>& normal_of) const;
  [[nodiscard]] bool covers(const ForceField& solved, std::size_t index) const;

  Scene scene_;
  SolverPlan plan_;
  ForceField truth_;
  FrameBuffer frame_;
  ForceField direct_;
  std::vector<std::size_t> open_;
};

/// What the field estimator is told, and may use.
struct Method {
  std::string name;
  FieldEvidence evidence;
  bool told_friction = false;
  bool told_slip = false;  ///< only for scenes that slip all over
  bool sequence = false;   ///< of kSequenceFrames, of which the last counts
};
inline constexpr int kSequenceFrames = 8;

/// Nothing said; shape alone; slip alone; neither; what may be told; the frame before.
[[nodiscard]] const std::vector<Method>& methods();

/// Of methods(): those that goals are about.
inline constexpr std::size_t kNothingSaid = 0;
inline constexpr std::size_t kFrictionTold = 3;
inline constexpr std::size_t kSlipTold = 5;

/// The forces of a scene by a method; nothing where it says what is not so.
[[nodiscard]] std::optional<ForceField> solve(const Scene& scene, const Observed& observed,
                                              const Method& method);

/// The plan of a method for a scene.
[[nodiscard]] SolverPlan plan_of(const Scene& scene, const Observed& observed,
                                 const Method& method);

/// Calls `work(i)` for 0 <= i < count on all cores.
void for_each_index(std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace pillarfield::field_study
