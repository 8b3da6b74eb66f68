#pragma once

#include <functional>
#include <span>
#include <vector>

#include "viewer/gpu/device.h"
#include "viewer/render/target.h"
#include "viewer/style/view.h"

struct ImGuiContext;

namespace pillarfield::viewer {

/// Corners of a picture in the texture of the font, 0..1.
struct TexturePlace {
  Vec2 low, high;
};

/// A Dear ImGui context with its fonts and buffers on a render pass: one for the overlay of
/// pictures, one for the panels of the window.
class GuiContext {
 public:
  /// `scale`: see RenderSettings. Text is DejaVu Sans where it is installed. `pictures`, at most
  /// 500 pixels wide, can be drawn from its texture: the back end has no other.
  GuiContext(const gpu::Instance& instance, const gpu::Device& device, vk::RenderPass render_pass,
             double scale, std::span<const Pixels> pictures = {});
  ~GuiContext();
  GuiContext(const GuiContext&) = delete;
  GuiContext& operator=(const GuiContext&) = delete;
  GuiContext(GuiContext&&) = delete;
  GuiContext& operator=(GuiContext&&) = delete;

  /// Makes this context the current one.
  void use() const;

  /// Records the frame of ImGui::Render() inside the render pass.
  void draw(const vk::raii::CommandBuffer& commands) const;

  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] const std::vector<TexturePlace>& pictures() const { return pictures_; }

 private:
  double scale_;
  ImGuiContext* context_;
  std::vector<TexturePlace> pictures_;
  vk::raii::DescriptorPool pool_ = nullptr;
};

}  // namespace pillarfield::viewer
