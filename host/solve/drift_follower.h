#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "solve/pattern_equations.h"
#include "solve/pillar_maths.h"

namespace pillarfield {

/// The pace of a plan's followed baseline; zero without one.
[[nodiscard]] single_precision::BaselinePace baseline_pace(const SolverPlan& plan);

/// Finds what the tares of untouched sensels have in common while they follow the readings, a plane
/// over the skin, by which the tares of touched sensels move too. Follows the mean tares of at most
/// 64 tiles, pillars with the eight around them, as follow_baseline.cl does all tares
/// (docs/derivations/sensor_effects.md, E11).
class DriftFollower {
 public:
  /// The plan must have a baseline_rate.
  explicit DriftFollower(const SolverPlan& plan);

  /// Amount to add to the touched tares of the pillar rows whose turn it is after this frame;
  /// `bent` is what was applied before it. Zero with crosstalk of wires, whose untouched sensels
  /// depend on loads.
  single_precision::Drift follow(const FrameView& frame, const std::optional<Curvature>& bent = {});

  /// Number of frames since the start.
  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  struct Sensel {
    std::uint32_t row;
    std::uint32_t col;
  };
  struct Tile {
    std::size_t first;  ///< of its sensels; those of the next tile follow
    std::size_t end;
    PatternTriple place;  ///< 1, then the column and row of its pillar from the middle, -1 to 1
    PatternTriple bend;   ///< means, counts mm
    double tare;          ///< mean, counts
    double difference;    ///< of the mean reading from it, in the last frame
    double trusted_from;  ///< the frame from which it tells the drift
    double_precision::Release release;
  };

  void add_tile(const SolverPlan& plan, std::size_t quad);
  template <class Value>
  [[nodiscard]] double mean(const Tile& tile, Value value) const;
  [[nodiscard]] bool is_near(const Tile& tile) const;
  [[nodiscard]] single_precision::Drift since_last_turn() const;

  std::vector<Tile> tiles_;
  std::vector<Sensel> sensels_;
  std::size_t cols_;
  PatternTriple middle_;  ///< 1, then half of the pillar columns and rows
  double rate_;
  double noise_;  ///< of a sensel, counts
  double limit_;  ///< largest difference that a tare follows: the threshold, counts
  double_precision::BaselinePace pace_;  ///< from frame to frame
  double settling_;                   ///< frames after which a tile that was off is trusted again
  PatternTriple drift_{};             ///< of readings from the tares, last frame
  PatternTriple sum_{};               ///< added to touched tares so far
  std::vector<PatternTriple> turns_;  ///< `sum_` after each of the last baseline_interval frames
  std::uint64_t frames_ = 0;
};

}  // namespace pillarfield
