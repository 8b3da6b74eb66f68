#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Leaks and their standard errors.
struct LeakEstimate {
  SenselLeak sensel;
  PillarLeak pillar;
};

/// The result of LeakFinder.
struct LeakResult {
  SkinCalibration calibration;
  LeakEstimate leak;
  LeakEstimate standard_error;
  bool inside_known = false;  ///< whether a pressed pillar had an inactive sensel; else inside is 0
  std::uint64_t presses = 0;  ///< isolated pillars in all frames that were used
  std::uint64_t left_out = 0;  ///< presses whose neighbours read unlike those of the others
  std::uint64_t places = 0;    ///< different pillars
  /// RMS reading of the sensels that carry no load, relative to the mean of the pressed pillar's,
  /// before and after the correction.
  double residual_before = 0;
  double residual_after = 0;
};

/// Finds the leaks between sensels and between pillars from a fine tip on single pillars
/// (docs/calibration.md).
///
/// Around an isolated pressed pillar the sensels read only leak. Memory: 152 bytes for each press,
/// at most kMostLeakPresses.
class LeakFinder {
 public:
  /// Throws Error if the calibration is of another skin or has no tare and noise.
  LeakFinder(const Skin& skin, const SkinCalibration& calibration);

  /// Adds a frame of the skin's size. Frames without an isolated pressed pillar count for nothing.
  void add(const FrameView& frame);

  /// The leaks so far. They replace those of the calibration, unless both of a kind lie within
  /// three standard errors of zero, and so do the counts per newton and the gains at the skin's
  /// edge, which contain a part of the leaks (rescale_for_leaks()). Throws Error without isolated
  /// pillars.
  [[nodiscard]] LeakResult result() const;

 private:
  /// Readings of the 3 x 3 pillars around a pressed one.
  struct Press {
    std::uint32_t pillar;
    std::array<float, 36> readings;
  };
  class Fit;
  [[nodiscard]] bool is_isolated(std::int64_t row, std::int64_t col) const;

  Skin skin_;
  SkinCalibration calibration_;
  double noise_;
  std::vector<double> sums_;  ///< of the pillars of the last frame
  std::vector<Press> presses_;
};

inline constexpr std::size_t kMostLeakPresses = 20000;

/// Replaces the leaks, and adapts counts per newton, dead zones, widths of plays and gains found
/// with the old ones:
/// under a uniform load a sensel reads 1 + 2 inside + 2 across times more, less across at the
/// skin's edge, and a pillar carries 1 + 4 edge + 4 corner times more.
void rescale_for_leaks(SkinCalibration& calibration, const Skin& skin,
                       const std::optional<SenselLeak>& sensel,
                       const std::optional<PillarLeak>& pillar);

}  // namespace pillarfield
