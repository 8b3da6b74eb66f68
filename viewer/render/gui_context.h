#pragma once

#include "viewer/gpu/device.h"

struct ImGuiContext;

namespace pillarfield::viewer {

/// A Dear ImGui context with its fonts and buffers on a render pass: one for the overlay of
/// pictures, one for the panels of the window.
class GuiContext {
 public:
  /// `scale`: see RenderSettings. Text is DejaVu Sans where it is installed.
  GuiContext(const gpu::Instance& instance, const gpu::Device& device, vk::RenderPass render_pass,
             double scale);
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

 private:
  double scale_;
  ImGuiContext* context_;
  vk::raii::DescriptorPool pool_ = nullptr;
};

}  // namespace pillarfield::viewer
