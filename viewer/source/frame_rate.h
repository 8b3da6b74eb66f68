#pragma once

#include <cstdint>
#include <functional>

namespace pillarfield::viewer {

/// Frames per second of a source, from the median step between the times of its first frames, of
/// which `time_of` tells; 100 where they do not rise.
[[nodiscard]] double frame_rate(std::uint64_t frames,
                                const std::function<double(std::uint64_t)>& time_of);

}  // namespace pillarfield::viewer
