#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield::bench {

/// What the pillars in contact are pressed with.
enum class Touch : std::uint8_t {
  one,     ///< forces of region 1: all four sensels read
  two,     ///< of region 2
  three,   ///< of region 3
  four,    ///< of region 4
  silent,  ///< nothing
  mixed,   ///< from all directions alike that some sensel feels
  worst,   ///< all of the above in turns, from one pillar to the next
};

/// What a series of frames shows.
struct Scenery {
  Touch touch = Touch::mixed;
  /// Share of the skin in contact, 0..1: below 1 in eight round contacts, which move from frame to
  /// frame.
  double contact = 1;
};

/// A series of frames of which no two are alike, in memory of their own. Readings are those of a
/// flawless sensor in whole counts, up to 240; uint16 ones have four bits more, and float32 ones
/// their fractions.
class Frames {
 public:
  /// 64 frames, or as many as a gibibyte holds.
  Frames(const Skin& skin, SenselType type, const Scenery& scenery);
  /// Frames of that skin that somebody else made, one or more.
  Frames(const Skin& skin, std::vector<FrameBuffer> frames);

  [[nodiscard]] std::size_t size() const { return frames_.size(); }
  /// Frames repeat from the size() th on.
  [[nodiscard]] FrameView operator[](std::size_t frame) const {
    return frames_[frame % frames_.size()].view();
  }

  /// Share of the pillars of all frames on which a sensel reads something.
  [[nodiscard]] double contact() const;

 private:
  Skin skin_;
  std::vector<FrameBuffer> frames_;
};

}  // namespace pillarfield::bench
