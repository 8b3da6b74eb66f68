#pragma once

#include <functional>

#include "viewer/gpu/device.h"

struct ImGuiContext;

namespace pillarfield::viewer {

/// Dear ImGui on a render pass: one for what is written into pictures, another for the panels of
/// the window. Each has a context, fonts and buffers of its own.
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

  /// The frame that ImGui::Render() finished is drawn, inside the render pass.
  void draw(const vk::raii::CommandBuffer& commands) const;

  [[nodiscard]] double scale() const { return scale_; }

 private:
  double scale_;
  ImGuiContext* context_;
  vk::raii::DescriptorPool pool_ = nullptr;
};

}  // namespace pillarfield::viewer
