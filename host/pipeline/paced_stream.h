#pragma once

#include <memory>

#include "pillarfield/frame_stream.h"
#include "pipeline/clock.h"

namespace pillarfield {

/// The public paced_stream() with another clock.
[[nodiscard]] std::unique_ptr<FrameStream> paced_stream(std::unique_ptr<FrameStream> stream,
                                                        const Pace& pace,
                                                        std::shared_ptr<Clock> clock);

}  // namespace pillarfield
