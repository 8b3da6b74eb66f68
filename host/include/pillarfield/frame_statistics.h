#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Statistics of one sensel's raw readings over many frames, counts. NaN and magnitudes above
/// kMaxCounts are skipped.
struct SenselStatistics {
  std::uint32_t readings = 0;   ///< number of readings, without skipped ones
  std::uint32_t saturated = 0;  ///< of these, at full scale or above
  float lowest = 0;
  float highest = 0;
  double mean = 0;
  double squares = 0;  ///< sum of squared differences from the mean

  /// Adds a reading.
  void add(float reading, float full_scale);

  /// Standard deviation of a reading (its square is unbiased); 0 for fewer than two.
  [[nodiscard]] double deviation() const;
};

/// Statistics of all sensels of a skin. Memory: 40 bytes per sensel, however many frames.
class FrameStatistics {
 public:
  /// Messages use `name` as the name of the frames, for instance that of their file.
  FrameStatistics(std::string name, const Skin& skin, SenselType type);

  /// Adds a frame of the skin's size and type; about 5 ns per sensel.
  void add(const FrameView& frame);
  /// Adds a frame of readings as [rows, cols] float32; NaN: no reading.
  void add(std::span<const float> readings);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Skin& skin() const { return skin_; }
  [[nodiscard]] SenselType type() const { return type_; }
  [[nodiscard]] std::uint32_t frames() const { return frames_; }

  /// One entry per sensel, [rows, cols], row by row.
  [[nodiscard]] std::span<const SenselStatistics> sensels() const { return sensels_; }

 private:
  std::string name_;
  Skin skin_;
  SenselType type_;
  std::uint32_t frames_ = 0;
  std::vector<SenselStatistics> sensels_;
};

/// Throws Error if `statistics` are of fewer than `least` frames.
void require_frames(const FrameStatistics& statistics, std::uint32_t least);

/// The mean frame, float32; a sensel at full scale in any frame is at full scale, one without
/// readings is NaN.
[[nodiscard]] FrameBuffer mean_frame(const FrameStatistics& frames);

}  // namespace pillarfield
