#include "viewer/gpu/image.h"

namespace pillarfield::viewer::gpu {

Image::Image(const Device& device, vk::Extent2D size, vk::Format format, vk::ImageUsageFlags usage,
             vk::ImageAspectFlags aspect)
    : size_(size),
      image_(device.handle(),
             vk::ImageCreateInfo({}, vk::ImageType::e2D, format, vk::Extent3D(size, 1), 1, 1,
                                 vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal, usage)) {
  const auto needs = image_.getMemoryRequirements();
  const std::uint32_t type =
      device.memory_type(needs.memoryTypeBits, {}, vk::MemoryPropertyFlagBits::eDeviceLocal);
  memory_ = vk::raii::DeviceMemory(device.handle(), {needs.size, type});
  image_.bindMemory(*memory_, 0);
  view_ = vk::raii::ImageView(
      device.handle(), vk::ImageViewCreateInfo({}, *image_, vk::ImageViewType::e2D, format, {},
                                               vk::ImageSubresourceRange(aspect, 0, 1, 0, 1)));
}

}  // namespace pillarfield::viewer::gpu
