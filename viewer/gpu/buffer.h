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

/// A device image with its view.
class Image {
 public:
  Image() = default;
  Image(const Device& device, vk::Extent2D size, vk::Format format, vk::ImageUsageFlags usage,
        vk::ImageAspectFlags aspect);

  [[nodiscard]] vk::Image handle() const { return *image_; }
  [[nodiscard]] vk::ImageView view() const { return *view_; }
  [[nodiscard]] vk::Extent2D size() const { return size_; }

 private:
  vk::Extent2D size_;
  // Destroyed in the order view, image, memory.
  vk::raii::DeviceMemory memory_ = nullptr;
  vk::raii::Image image_ = nullptr;
  vk::raii::ImageView view_ = nullptr;
};

}  // namespace pillarfield::viewer::gpu
