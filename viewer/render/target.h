#pragma once

#include <cstdint>
#include <vector>

#include "viewer/gpu/buffer.h"

namespace pillarfield::viewer {

/// RGBA, 8 bits each, rows from the top.
struct Pixels {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> rgba;
};

/// Colour and depth images of a picture; after the render pass the colour image can be copied.
class Target {
 public:
  Target(const gpu::Device& device, vk::RenderPass render_pass, vk::Extent2D size);

  [[nodiscard]] const gpu::Image& image() const { return colour_; }
  [[nodiscard]] vk::Framebuffer framebuffer() const { return *framebuffer_; }

  static constexpr vk::Format kFormat = vk::Format::eR8G8B8A8Unorm;
  static constexpr vk::Format kDepthFormat = vk::Format::eD32Sfloat;
  [[nodiscard]] static vk::raii::RenderPass make_render_pass(const gpu::Device& device);

 private:
  gpu::Image colour_;
  gpu::Image depth_;
  vk::raii::Framebuffer framebuffer_ = nullptr;
};

/// Reads back a picture whose commands are complete.
[[nodiscard]] Pixels read_pixels(const gpu::Device& device, const gpu::Image& image);

}  // namespace pillarfield::viewer
