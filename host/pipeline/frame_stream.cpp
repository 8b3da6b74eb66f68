#include "pillarfield/frame_stream.h"

namespace pillarfield {

const Calibration& FrameStream::calibration() const {
  static const Calibration kNone;
  return kNone;
}

}  // namespace pillarfield
