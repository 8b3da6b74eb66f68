#pragma once

#include <cstdint>
#include <functional>

namespace pillarfield::viewer {

/// Frames per second: the inverse of the median step between the times of the first frames; 100
/// where the times do not rise.
[[nodiscard]] double frame_rate(std::uint64_t frames,
                                const std::function<double(std::uint64_t)>& time_of);

}  // namespace pillarfield::viewer
