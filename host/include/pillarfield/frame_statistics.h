#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// What one sensel read over many frames, in raw counts. Readings that are no number of at
/// most kMaxCounts are passed over, as if their frames had not been.
struct SenselStatistics {
  std::uint32_t readings = 0;   ///< that are numbers
  std::uint32_t saturated = 0;  ///< of these at full scale or above
  float lowest = 0;
  float highest = 0;
  double mean = 0;
  double squares = 0;  ///< sum of the squared differences from the mean

  void add(float reading, float full_scale);

  /// Standard deviation of a reading, unbiased in its square; 0 for less than two.
  [[nodiscard]] double deviation() const;
};

/// The same for all sensels of a skin; 40 bytes each, however many frames there are.
class FrameStatistics {
 public:
  /// `name` stands for the frames in messages, as their file.
  FrameStatistics(std::string name, const Skin& skin, SenselType type);

  /// Adds a frame of the skin's size and type; about 5 ns per sensel.
  void add(const FrameView& frame);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const Skin& skin() const { return skin_; }
  [[nodiscard]] SenselType type() const { return type_; }
  [[nodiscard]] std::uint32_t frames() const { return frames_; }

  /// Row by row, [rows, cols].
  [[nodiscard]] std::span<const SenselStatistics> sensels() const { return sensels_; }

 private:
  std::string name_;
  Skin skin_;
  SenselType type_;
  std::uint32_t frames_ = 0;
  std::vector<SenselStatistics> sensels_;
};

/// Throws Error, naming `statistics`, where they are of fewer than `least` frames.
void require_frames(const FrameStatistics& statistics, std::uint32_t least);

}  // namespace pillarfield
