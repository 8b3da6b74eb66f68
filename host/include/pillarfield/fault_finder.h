#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

struct FaultOptions {
  std::uint32_t least_frames = 30;  ///< in which parity must have told of a sensel
  double still_factor = 10;  ///< a range of so many times its noise is no movement of a reading
  /// A standard deviation of so many times its noise is a movement of what parity leaves.
  double moving_factor = 5;
};

/// What many frames told of the sensels.
struct FaultResult {
  SkinCalibration calibration;
  /// Masked: not_a_number, silent, stuck and saturated. Not masked: undecided.
  std::vector<SenselFinding> findings;
  /// [row, col] of sensels of which nothing can be said: they were not asked to answer.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> untested;
  std::uint32_t frames = 0;
};

/// Finds dead, stuck and permanently saturated sensels by parity over time (docs/calibration.md).
///
/// A sensel is at fault where its reading stays still while what the other three of its pillar
/// leave for it by V1 + V3 = V2 + V4, within what a sensel can show, moves. Frames are taken one by
/// one; 72 bytes per sensel are kept.
class FaultFinder {
 public:
  /// `name` stands for the frames in messages. Throws Error where the calibration is not one of
  /// this skin.
  FaultFinder(std::string name, const Skin& skin, SenselType type,
              const SkinCalibration& calibration, const FaultOptions& options);

  /// Adds a frame of the skin's size and type; about 20 ns per sensel.
  void add(const FrameView& frame);

  /// Throws Error where the frames are too few or nothing moved in them.
  [[nodiscard]] FaultResult result() const;

 private:
  /// What parity left for a sensel in the frames in which the other three were usable.
  struct Implied {
    std::uint32_t frames = 0;
    std::uint32_t usable = 0;  ///< frames in which the sensel itself was
    double mean = 0;
    double squares = 0;
  };
  /// What V a sensel can tell apart, counts.
  struct Sight {
    double least;
    double most;
  };
  class Verdict;

  [[nodiscard]] Sight sight_of(std::size_t sensel) const;
  void imply(std::size_t row, std::size_t col, const FrameView& frame);

  FrameStatistics statistics_;
  SkinCalibration calibration_;
  FaultOptions options_;
  SolverPlan plan_;
  std::vector<Implied> implied_;
};

}  // namespace pillarfield
