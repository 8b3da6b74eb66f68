#pragma once

#include <exception>

namespace pillarfield::viewer::gpu {

/// True if `error` reports a lost graphics device. Needs no Vulkan header.
[[nodiscard]] bool is_device_lost(const std::exception& error);

}  // namespace pillarfield::viewer::gpu
