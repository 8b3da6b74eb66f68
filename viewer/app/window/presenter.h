#pragma once

#include "viewer/gpu/swap_chain.h"
#include "viewer/render/renderer.h"

namespace pillarfield::viewer {

/// Brings picture and panels together in the images of a window. One frame is on its way at a time:
/// draw() returns when it is drawn, so that every buffer exists once.
class Presenter {
 public:
  Presenter(const gpu::Instance& instance, const gpu::Device& device, vk::SurfaceKHR surface,
            double scale);

  /// Another size of the window, of the picture in it, or of everything. False while the window has
  /// no pixels: nothing can be drawn then.
  bool resize(vk::Extent2D window, vk::Extent2D picture, double scale);

  /// The window changed under it: resize() is due, whatever the sizes.
  [[nodiscard]] bool stale() const { return chain_.stale(); }
  [[nodiscard]] vk::Extent2D size() const { return chain_.size(); }

  /// What the picture is to be of; none: it stays as it is.
  struct Picture {
    const ShownField& field;
    const SourceInfo& source;
    const RenderSettings& settings;
  };

  /// Draws the picture anew or keeps it, puts it at the upper left corner, draws the frame that
  /// ImGui::Render() finished in front() over it, and shows that. False where the window had no
  /// image to give just now: nothing was drawn.
  bool draw(const Picture* picture);

  /// The ImGui of the panels.
  [[nodiscard]] const GuiContext& gui() const { return *gui_; }
  [[nodiscard]] Renderer& renderer() { return renderer_; }

  /// Waits until the device is done with everything.
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
