#include "skin/raw_reading.h"

#include <fmt/format.h>

#include "pillarfield/error.h"

namespace pillarfield {

void require_frame(const FrameView& frame, const Skin& skin, SenselType type,
                   const std::string& where) {
  if (frame.type == type && frame.rows == skin.rows && frame.cols == skin.cols &&
      frame.row_stride >= frame.cols && frame.data != nullptr) {
    return;
  }
  throw Error(where,
              fmt::format("a frame is {} x {} {}", frame.rows, frame.cols, name_of(frame.type)),
              fmt::format("its frames are {} x {} {}", skin.rows, skin.cols, name_of(type)));
}

}  // namespace pillarfield
