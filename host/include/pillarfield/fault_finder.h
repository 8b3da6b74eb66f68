#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/force_field.h"
#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Frames that a fault needs, and of those as many in which parity predicts the sensel.
inline constexpr std::uint32_t kLeastFaultFrames = 30;

/// The result of FaultFinder.
struct FaultResult {
  SkinCalibration calibration;
  /// Masked: not_a_number, saturated, unresponsive, stuck. Not masked: unknown.
  std::vector<SenselFinding> findings;
  /// [row, col] of sensels that no frame tests: parity never predicts them to change.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> untested;
  std::uint32_t frames = 0;  ///< frames added
};

/// Finds dead, stuck and permanently saturated sensels by parity over time (docs/calibration.md).
///
/// A sensel is faulty if its reading is still while the value that the other three predict by
/// V1 + V3 = V2 + V4, clipped to its range, moves. Memory: 72 bytes per sensel, however many
/// frames.
class FaultFinder {
 public:
  /// Messages use `name` as the name of the frames. Throws Error if the calibration is of another
  /// skin.
  FaultFinder(std::string name, const Skin& skin, SenselType type,
              const SkinCalibration& calibration, std::uint32_t least_frames = kLeastFaultFrames);

  /// Adds a frame of the skin's size and type; about 20 ns per sensel.
  void add(const FrameView& frame);

  /// Statistics of the raw readings of all frames so far.
  [[nodiscard]] const FrameStatistics& statistics() const { return statistics_; }

  /// The findings so far. Throws Error if the frames are too few or nothing moves in them.
  [[nodiscard]] FaultResult result() const;

 private:
  /// The value that parity predicts for a sensel, over frames in which the other three are usable.
  struct Prediction {
    std::uint32_t frames = 0;
    std::uint32_t usable = 0;  ///< frames in which the sensel itself is usable
    double mean = 0;
    double squares = 0;
  };
  /// The range of V that a sensel can show, counts.
  struct Range {
    double least;
    double most;
  };
  class Classifier;

  [[nodiscard]] Range range_of(std::size_t sensel) const;
  /// Adds the predictions of a pillar from its sensels in a frame.
  void predict(const std::array<std::size_t, 4>& sensels, const ForceField& corrected);

  FrameStatistics statistics_;
  SkinCalibration calibration_;
  std::uint32_t least_frames_;
  SolverPlan plan_;
  SolverPlan sensels_;  ///< of its sensels alone, in counts
  std::vector<Prediction> predictions_;
};

}  // namespace pillarfield
