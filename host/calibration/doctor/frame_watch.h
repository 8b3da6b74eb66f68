#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pillarfield/frame.h"

namespace pillarfield {

/// A frame beside the one before it.
enum class FrameKind : std::uint8_t {
  whole,
  empty,     ///< no reading
  uniform,   ///< one value everywhere but where a sensel is absent
  repeated,  ///< equal to the one before
};

/// Finds frames that carry no readings of their own, one after the other. Memory: two frames, and 4
/// bytes a frame.
class FrameWatch {
 public:
  FrameKind add(const FrameView& frame);

  /// A number of frames and the first of them, from 0.
  struct Count {
    std::uint64_t frames = 0;
    std::uint64_t first = 0;

    void add(std::uint64_t frame) { first = frames++ == 0 ? frame : first; }
  };
  [[nodiscard]] const Count& empty() const { return empty_; }
  [[nodiscard]] const Count& repeated() const { return repeated_; }
  /// Uniform frames between two others that resemble each other, so that no touch explains them.
  [[nodiscard]] const Count& lost() const { return lost_; }
  /// The value of the uniform frames, counts.
  [[nodiscard]] float uniform_value() const { return value_; }

  /// True if lost frames explain the uniform ones.
  [[nodiscard]] bool uniform_are_lost() const {
    return lost_.frames > 0 && 5 * lost_.frames >= 4 * uniform_.frames && 20 * flat_ < frames_;
  }
  /// True if the other frames change so much that equal ones are no chance.
  [[nodiscard]] bool repeats_are_odd() const;
  [[nodiscard]] bool is_frozen() const { return frames_ > 1 && all_equal_; }

 private:
  void end_run(double mean);

  std::uint64_t frames_ = 0;
  bool all_equal_ = true;
  std::vector<float> current_;
  std::vector<float> before_;
  std::vector<float> numbers_;          ///< finite readings of the current frame
  std::vector<std::uint32_t> changes_;  ///< sensels that changed, of whole frames
  Count empty_;
  Count repeated_;
  Count uniform_;
  Count lost_;
  std::uint64_t flat_ = 0;  ///< whole frames most of whose sensels read the same
  Count run_;               ///< uniform frames up to now
  double run_mean_ = 0;     ///< of these
  double mean_ = 0;         ///< of the last whole frame
  bool has_mean_ = false;
  float value_ = 0;
};

}  // namespace pillarfield
