#pragma once

#include "viewer/gpu/device.h"

namespace pillarfield::viewer::gpu {

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
