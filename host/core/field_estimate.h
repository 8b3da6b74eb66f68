#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/field_work.h"
#include "core/work_team.h"
#include "pillarfield/force_field.h"

namespace pillarfield {

/// The field estimator as a plain C++ loop over the same mathematics as the device's: the same bits
/// (docs/derivations/field.md).
class HostFieldEstimator {
 public:
  /// With several threads, contacts are shared among them: the same bits.
  explicit HostFieldEstimator(const SolverPlan& plan, std::size_t threads = 1);

  /// Resolves what the direct solve of the plan left open in a frame. Where the plan says that
  /// frames are close in time, each call is the next frame.
  void resolve(ForceField& field);

  /// The same of planes of the plan's size; those from magnitude on may be null. Of silent blocks
  /// nothing is read.
  void resolve(const single_precision::Field& field, const SilentBlocks& silent = {});

  [[nodiscard]] const FieldWork& work() const { return work_; }
  /// One for each tile of the last frame's work.
  [[nodiscard]] const std::vector<single_precision::Verdict>& verdicts() const { return verdicts_; }

 private:
  /// Memory for one contact at a time: a thread's own, so that it stays in its cache.
  struct Room {
    std::vector<std::uint8_t> kinds;
    std::vector<float> planes;
    std::vector<double> lines;
    std::vector<double> shared;
    std::vector<std::uint32_t> counts;

    /// For a tile whose cells and lines are counted from 0.
    single_precision::Scratch scratch(const single_precision::Tile& tile);
  };

  single_precision::Past past();
  static void ask_for(const single_precision::Field& field,
                      std::span<const single_precision::Run> runs);
  single_precision::Verdict resolve_tile(const single_precision::Field& field,
                                         single_precision::Tile tile, Room& room);
  void resolve_alone(const single_precision::Field& field, std::span<const std::uint32_t> pillars);

  FieldWork work_;
  std::vector<Room> rooms_;  ///< of each thread
  std::vector<single_precision::Verdict> verdicts_;
  std::vector<single_precision::Run> runs_;
  std::vector<float> past_normal_;  ///< empty where frames are not close
  std::vector<float> past_deviation_;
  std::vector<std::uint32_t> past_frame_;
  std::uint32_t now_ = 1;  ///< frames that were seen, and one: pillars begin with frame 0
  std::unique_ptr<WorkTeam> team_;
};

}  // namespace pillarfield
