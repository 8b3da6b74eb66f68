#pragma once

#include <functional>

#include "viewer/gpu/device.h"

struct ImGuiContext;

namespace pillarfield::viewer {

/// Dear ImGui on a render pass: one for what is written into pictures, another for the panels of
/// the window. Each has a context, fonts and buffers of its own.
class Interface {
 public:
  /// `scale`: see Look. Text is DejaVu Sans where it is installed.
  Interface(const gpu::Instance& instance, const gpu::Device& device, vk::RenderPass render_pass,
            double scale);
  ~Interface();
  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;
  Interface(Interface&&) = delete;
  Interface& operator=(Interface&&) = delete;

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
