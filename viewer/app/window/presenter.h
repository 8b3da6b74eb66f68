#pragma once

#include "viewer/gpu/swap_chain.h"
#include "viewer/render/renderer.h"

namespace pillarfield::viewer {

/// Composes picture and panels in the images of a window. draw() returns when the frame is drawn,
/// so that every buffer exists once.
class Presenter {
 public:
  Presenter(const gpu::Instance& instance, const gpu::Device& device, vk::SurfaceKHR surface,
            double scale);

  /// Sets the sizes of window and picture, and the scale. Returns false for a window without
  /// pixels, which cannot be drawn.
  bool resize(vk::Extent2D window, vk::Extent2D picture, double scale);

  /// The window has changed: call resize(), even with equal sizes.
  [[nodiscard]] bool stale() const { return chain_.stale(); }
  [[nodiscard]] vk::Extent2D size() const { return chain_.size(); }

  /// Contents of a new picture; null keeps the old one.
  struct Picture {
    const ShownField& field;
    const SourceInfo& source;
    const RenderSettings& settings;
  };

  /// Draws the picture, if given, copies it to the upper left corner, draws the frame of
  /// ImGui::Render() in gui() over it, and presents. Returns false, drawing nothing, where the
  /// window has no image available.
  bool draw(const Picture* picture);

  /// The ImGui context of the panels.
  [[nodiscard]] const GuiContext& gui() const { return *gui_; }
  [[nodiscard]] Renderer& renderer() { return renderer_; }

  /// Waits until the device is idle.
  void finish() const { device_->handle().waitIdle(); }

 private:
  void record(std::uint32_t index, const Picture* picture);
  void copy_picture(vk::Image image) const;
  void draw_gui(std::uint32_t index) const;
  void submit(std::uint32_t index);
  void make_framebuffers();

  const gpu::Instance* instance_;
  const gpu::Device* device_;
  gpu::SwapChain chain_;
  vk::raii::RenderPass render_pass_;
  Renderer renderer_;
  bool has_picture_ = false;
  std::unique_ptr<GuiContext> gui_;
  std::vector<vk::raii::Framebuffer> framebuffers_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
  vk::raii::Semaphore ready_;
  vk::raii::Fence done_;
};

}  // namespace pillarfield::viewer
