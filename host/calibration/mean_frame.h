#pragma once

#include "pillarfield/frame.h"
#include "pillarfield/frame_statistics.h"

namespace pillarfield {

/// The mean frame, float32; a sensel at full scale in any frame is at full scale, one without
/// readings is NaN.
[[nodiscard]] FrameBuffer mean_frame(const FrameStatistics& frames);

}  // namespace pillarfield
