#pragma once

#include <optional>
#include <vector>

#include "viewer/gpu/device.h"

namespace pillarfield::viewer::gpu {

/// The images that a window shows in turn: 8-bit red, green and blue without a curve of its own,
/// which can be copied into.
class SwapChain {
 public:
  /// Throws Error where the surface has no such images. There are none before resize().
  SwapChain(const Device& device, vk::SurfaceKHR surface);

  [[nodiscard]] vk::Format format() const { return format_; }

  /// Makes the images anew; nothing that uses the old ones may be running. `wished` counts where
  /// the surface leaves its size open. False where the window has no pixels now (minimised): there
  /// are no images then.
  bool resize(vk::Extent2D wished);

  [[nodiscard]] vk::Extent2D size() const { return size_; }
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(images_.size()); }
  [[nodiscard]] vk::Image image(std::uint32_t index) const { return images_.at(index); }
  [[nodiscard]] vk::ImageView view(std::uint32_t index) const { return *views_.at(index); }

  /// The image to draw next; `ready` is signalled when it may be drawn into. None where there is
  /// none now: look at stale().
  [[nodiscard]] std::optional<std::uint32_t> acquire(vk::Semaphore ready);

  /// Signalled by the commands that drew image `index`; present() waits for it.
  [[nodiscard]] vk::Semaphore drawn(std::uint32_t index) const { return *drawn_.at(index); }
  void present(std::uint32_t index);

  /// The window changed: resize() is due.
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
