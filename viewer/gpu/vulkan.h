#pragma once

// The only include of Vulkan, with common settings.
#include <vulkan/vulkan_raii.hpp>
