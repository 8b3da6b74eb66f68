#pragma once

#include <exception>

namespace pillarfield::viewer::gpu {

/// Whether `error` says that the graphics device was lost. Needs no header of Vulkan.
[[nodiscard]] bool is_device_lost(const std::exception& error);

}  // namespace pillarfield::viewer::gpu
