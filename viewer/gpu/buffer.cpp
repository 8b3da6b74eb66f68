#include "viewer/gpu/buffer.h"

#include "pillarfield/error.h"

namespace pillarfield::viewer::gpu {
namespace {

constexpr auto kHostPointer = vk::ExternalMemoryHandleTypeFlagBits::eHostAllocationEXT;

}  // namespace

Buffer::Buffer(const Device& device, std::size_t bytes, vk::BufferUsageFlags usage, Place place)
    : size_(bytes), buffer_(device.handle(), vk::BufferCreateInfo({}, bytes, usage)) {
  using Property = vk::MemoryPropertyFlagBits;
  const auto needs = buffer_.getMemoryRequirements();
  const std::uint32_t type =
      place == Place::host ? device.memory_type(needs.memoryTypeBits,
                                                Property::eHostVisible | Property::eHostCoherent,
                                                Property::eHostCached)
                           : device.memory_type(needs.memoryTypeBits, {}, Property::eDeviceLocal);
  memory_ = vk::raii::DeviceMemory(device.handle(), {needs.size, type});
  buffer_.bindMemory(*memory_, 0);
  if (place == Place::host) data_ = static_cast<std::byte*>(memory_.mapMemory(0, VK_WHOLE_SIZE));
}

Buffer::Buffer(const Device& device, std::span<const std::byte> pages, vk::BufferUsageFlags usage)
    : size_(pages.size()) {
  const vk::ExternalMemoryBufferCreateInfo external(kHostPointer);
  buffer_ = vk::raii::Buffer(device.handle(),
                             vk::BufferCreateInfo({}, size_, usage, {}, {}, {}, &external));
  // Vulkan takes host memory as non-const even if it is only read.
  void* const address = const_cast<std::byte*>(pages.data());
  const auto possible = device.handle().getMemoryHostPointerPropertiesEXT(kHostPointer, address);
  const auto needs = buffer_.getMemoryRequirements();
  const std::uint32_t type = device.memory_type(possible.memoryTypeBits & needs.memoryTypeBits, {});
  const vk::ImportMemoryHostPointerInfoEXT import(kHostPointer, address);
  memory_ = vk::raii::DeviceMemory(device.handle(), vk::MemoryAllocateInfo(size_, type, &import));
  buffer_.bindMemory(*memory_, 0);
}

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
