#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield::bench {

/// Load of the pillars in contact.
enum class Touch : std::uint8_t {
  one,    ///< forces of region 1
  two,    ///< forces of region 2
  three,  ///< forces of region 3
  four,   ///< forces of region 4
  idle,   ///< none
  mixed,  ///< directions uniform over the hemisphere, at least one sensel active
  worst,  ///< regions 1 to 4 and idle in turns, from one pillar to the next
};

/// Content of a series of frames.
struct Scenario {
  Touch touch = Touch::mixed;
  /// Fraction of the skin in contact, 0..1: below 1, eight round contacts that move from frame to
  /// frame.
  double contact = 1;
};

/// A series of distinct frames. Readings are ideal, up to 240 counts: rounded to whole counts in
/// uint8, to sixteenths (stored times 16) in uint16, not rounded in float32.
class Frames {
 public:
  /// 64 frames, or as many as fit in 1 GiB, at least 2.
  Frames(const Skin& skin, SenselType type, const Scenario& scenario);
  /// Wraps one or more given frames.
  explicit Frames(std::vector<FrameBuffer> frames) : frames_(std::move(frames)) {}

  [[nodiscard]] std::size_t size() const { return frames_.size(); }
  /// Frames repeat after size().
  [[nodiscard]] FrameView operator[](std::size_t frame) const {
    return frames_[frame % frames_.size()].view();
  }

 private:
  std::vector<FrameBuffer> frames_;
};

}  // namespace pillarfield::bench
