#pragma once

#include <optional>
#include <vector>

#include "viewer/gpu/device.h"

namespace pillarfield::viewer::gpu {

/// The images of a window: 8-bit UNORM, valid as copy destinations.
class SwapChain {
 public:
  /// Creates no images before resize(). Throws Error where the surface lacks the format.
  SwapChain(const Device& device, vk::SurfaceKHR surface);

  [[nodiscard]] vk::Format format() const { return format_; }

  /// Recreates the images; commands that use the old ones must be complete. `preferred` applies
  /// where the surface does not fix the size. Returns false, without images, for a minimised
  /// window.
  bool resize(vk::Extent2D preferred);

  [[nodiscard]] vk::Extent2D size() const { return size_; }
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(images_.size()); }
  [[nodiscard]] vk::Image image(std::uint32_t index) const { return images_.at(index); }
  [[nodiscard]] vk::ImageView view(std::uint32_t index) const { return *views_.at(index); }

  /// Index of the next image; `ready` is signalled when it may be drawn into. None where no image
  /// is available: check stale().
  [[nodiscard]] std::optional<std::uint32_t> acquire(vk::Semaphore ready);

  /// Signalled by the commands that drew image `index`; present() waits for it.
  [[nodiscard]] vk::Semaphore drawn(std::uint32_t index) const { return *drawn_.at(index); }
  void present(std::uint32_t index);

  /// The window has changed; call resize().
  [[nodiscard]] bool stale() const { return stale_; }

 private:
  void make_images();

  const Device* device_;
  vk::SurfaceKHR surface_;
  vk::Format format_;
  vk::ColorSpaceKHR colour_space_;
  vk::PresentModeKHR mode_;
  vk::Extent2D size_;
  bool stale_ = true;
  vk::raii::SwapchainKHR chain_ = nullptr;
  std::vector<vk::Image> images_;
  std::vector<vk::raii::ImageView> views_;
  std::vector<vk::raii::Semaphore> drawn_;
};

}  // namespace pillarfield::viewer::gpu
