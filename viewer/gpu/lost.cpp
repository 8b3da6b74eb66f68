#include "viewer/gpu/lost.h"

#include "viewer/gpu/vulkan.h"

namespace pillarfield::viewer::gpu {

bool is_device_lost(const std::exception& error) {
  return dynamic_cast<const vk::DeviceLostError*>(&error) != nullptr;
}

}  // namespace pillarfield::viewer::gpu
