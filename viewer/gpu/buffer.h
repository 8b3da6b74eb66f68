#pragma once

#include <cstddef>
#include <span>

#include "viewer/gpu/device.h"

namespace pillarfield::viewer::gpu {

/// A host-visible, mapped buffer or a device-local one.
class Buffer {
 public:
  enum class Place { host, device };

  Buffer() = default;
  Buffer(const Device& device, std::size_t bytes, vk::BufferUsageFlags usage, Place place);

  /// Imports host memory, which must outlive the buffer. Address and size of `pages` are multiples
  /// of Device::import_alignment(). Throws Error where the device refuses.
  Buffer(const Device& device, std::span<const std::byte> pages, vk::BufferUsageFlags usage);

  [[nodiscard]] vk::Buffer handle() const { return *buffer_; }
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Host address of a Place::host buffer; coherent.
  [[nodiscard]] std::byte* data() const { return data_; }

 private:
  std::size_t size_ = 0;
  std::byte* data_ = nullptr;
  // Declared before the buffer, which is destroyed first.
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Buffer buffer_ = nullptr;
};

}  // namespace pillarfield::viewer::gpu
