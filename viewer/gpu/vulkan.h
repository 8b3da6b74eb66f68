#pragma once

// The one place that includes Vulkan, so that all files see it with the same settings.
#include <vulkan/vulkan_raii.hpp>
