#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/frame_statistics.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// Frames of a skin that nothing touches, with statistics of all of them. Keeps at most 4096
/// frames, and 64 MiB or 32 frames of them: of more, each second, fourth ... frame, which then are
/// those of the tare.
class TareFrames : public FrameStatistics {
 public:
  using FrameStatistics::FrameStatistics;

  /// Adds a frame of the skin's size and type, that came at `time_s` if messages are to say so.
  void add(const FrameView& frame, double time_s = std::numeric_limits<double>::quiet_NaN());

  [[nodiscard]] std::size_t kept() const { return kept_.size(); }
  /// Readings of a kept frame, [rows, cols].
  [[nodiscard]] std::span<const float> readings(std::size_t kept) const { return kept_[kept]; }
  /// "in frames 3 to 17" or "from 0.1 to 0.3 s", of kept frames.
  [[nodiscard]] std::string span_words(std::size_t first, std::size_t last) const;

 private:
  std::vector<std::vector<float>> kept_;
  std::vector<double> times_s_;
  std::uint32_t step_ = 1;
};

/// Options of take_tare().
struct TareOptions {
  double threshold_factor = 4;  ///< see set_threshold()
  bool preloaded = false;       ///< accept what resembles a touch: the skin is bent or covered
  const char* otherwise = "accept it with --preloaded";  ///< last words of a refusal; null: none
};

/// The result of take_tare().
struct TareResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< all masked
  double tare_counts = 0;               ///< median of the good sensels
  double noise_counts = 0;              ///< median of the good sensels
  double unseen_counts = 0;             ///< a touch of less on a sensel would not have been seen
  std::size_t spikes = 0;               ///< readings left out: they stand out for a frame or two
};

/// Least number of frames for a tare: of fewer a noisy sensel, a tap and noise are not told apart.
inline constexpr std::uint32_t kLeastTareFrames = 20;

/// Measures the tare (mean) and the noise (standard deviation) of each sensel on the unloaded skin,
/// sets the threshold, and masks faulty sensels. Keeps everything else of `before`. Formulas and
/// limits: docs/calibration.md. Throws Error if the frames are too few or of another skin, and,
/// unless preloaded, if something touches the skin or the tare is much worse than that of `before`:
/// it masks sensels that were good, or its threshold is over twice as high.
[[nodiscard]] TareResult take_tare(const SkinCalibration& before, const TareFrames& unloaded,
                                   const TareOptions& options);

/// Throws Error if something touches the skin in a part of the frames.
void refuse_moving_touch(const TareFrames& unloaded, std::span<const std::uint8_t> mask,
                         const char* otherwise);

}  // namespace pillarfield
