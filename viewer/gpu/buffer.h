#pragma once

#include <cstddef>
#include <span>

#include "viewer/gpu/device.h"

namespace pillarfield::viewer::gpu {

/// A buffer that both sides see at one address, or one of the device alone.
class Buffer {
 public:
  enum class Place { host, device };

  Buffer() = default;
  Buffer(const Device& device, std::size_t bytes, vk::BufferUsageFlags usage, Place place);

  /// Memory of somebody else, read in place. `pages`: address and size are multiples of
  /// Device::import_alignment(); it must outlive the buffer. Throws Error where the device refuses.
  Buffer(const Device& device, std::span<const std::byte> pages, vk::BufferUsageFlags usage);

  [[nodiscard]] vk::Buffer handle() const { return *buffer_; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Where the host sees a buffer of Place::host; coherent.
  [[nodiscard]] std::byte* data() const { return data_; }

 private:
  std::size_t size_ = 0;
  std::byte* data_ = nullptr;
  // The buffer goes before the memory that it is bound to.
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
};

}  // namespace pillarfield::viewer::gpu
