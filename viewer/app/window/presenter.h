#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "viewer/gpu/swap_chain.h"
#include "viewer/render/renderer.h"

namespace pillarfield::viewer {

/// Composes picture and panels in the images of a window. draw() returns when the frame is drawn,
/// so that every buffer exists once.
class Presenter {
 public:
  Presenter(const gpu::Instance& instance, const gpu::Device& device, vk::SurfaceKHR surface,
            double scale);

  /// A picture's place, in pixels of the window.
  struct Place {
    vk::Offset2D corner;
    vk::Extent2D size;
    friend bool operator==(const Place&, const Place&) = default;
  };

  /// Sets the size of the window, the place of its picture, if it has one, and the scale. Returns
  /// false for a window without pixels, which cannot be drawn.
  bool resize(vk::Extent2D window, const std::optional<Place>& place, double scale);
  [[nodiscard]] const std::optional<Place>& place() const { return place_; }

  /// The window has changed: call resize(), even with equal sizes.
  [[nodiscard]] bool stale() const { return chain_.stale(); }
  [[nodiscard]] vk::Extent2D size() const { return chain_.size(); }

  /// Contents of a picture.
  struct Picture {
    const ShownField& field;
    const SourceInfo& source;
    const RenderSettings& settings;
  };

  /// Draws the picture that is given, copies it to its place, draws the frame of ImGui::Render() in
  /// gui() over it, and presents. Without one the picture keeps its contents. Returns false,
  /// drawing nothing, where the window has no image available.
  bool draw(const std::optional<Picture>& picture);

  /// Forgets the contents of the picture and the memory of its fields.
  void clear();

  /// The ImGui context of the panels.
  [[nodiscard]] const GuiContext& gui() const { return *gui_; }
  [[nodiscard]] const gpu::Image& image() const { return renderer_.image(); }
  [[nodiscard]] Renderer& renderer() { return renderer_; }

  /// Waits until the device is idle.
  void finish() const { device_->handle().waitIdle(); }

 private:
  void record(std::uint32_t index, const std::optional<Picture>& picture);
  void copy_picture_or_blank(vk::Image image) const;
  void copy_picture(vk::Image image, const gpu::Image& picture, const Place& place) const;
  void draw_gui(std::uint32_t index) const;
  void submit(std::uint32_t index);
  void make_framebuffers();
  [[nodiscard]] std::unique_ptr<GuiContext> make_gui(double scale) const;

  const gpu::Instance* instance_;
  const gpu::Device* device_;
  gpu::SwapChain chain_;
  vk::raii::RenderPass render_pass_;
  Renderer renderer_;
  std::optional<Place> place_;
  bool has_picture_ = false;
  std::unique_ptr<GuiContext> gui_;
  std::vector<vk::raii::Framebuffer> framebuffers_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
  vk::raii::Semaphore ready_;
  vk::raii::Fence done_;
};

}  // namespace pillarfield::viewer
