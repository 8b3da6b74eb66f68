#include "pillarfield/frame_stream.h"

namespace pillarfield {

const Calibration& FrameStream::calibration() const {
  static const Calibration none;
  return none;
}

StreamHealth FrameStream::health() const { return {}; }

}  // namespace pillarfield
