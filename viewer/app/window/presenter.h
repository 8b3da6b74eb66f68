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

  /// Sets the size of the window, the places of its pictures and the scale. Returns false for a
  /// window without pixels, which cannot be drawn.
  bool resize(vk::Extent2D window, const std::vector<Place>& places, double scale);
  [[nodiscard]] const std::vector<Place>& places() const { return places_; }

  /// The window has changed: call resize(), even with equal sizes.
  [[nodiscard]] bool stale() const { return chain_.stale(); }
  [[nodiscard]] vk::Extent2D size() const { return chain_.size(); }

  /// Contents of a picture.
  struct Picture {
    const ShownField& field;
    const SourceInfo& source;
    const RenderSettings& settings;
  };

  /// Draws the pictures that are given, in the order of places(), copies all to their places, draws
  /// the frame of ImGui::Render() in gui() over them, and presents. A picture that is not given
  /// keeps its contents. Returns false, drawing nothing, where the window has no image available.
  bool draw(const std::vector<std::optional<Picture>>& pictures);

  /// Forgets the contents of all pictures and the memory of their fields.
  void clear();

  /// The ImGui context of the panels.
  [[nodiscard]] const GuiContext& gui() const { return *gui_; }
  [[nodiscard]] const gpu::Image& image(std::size_t index) const {
    return parts_.at(index).renderer->image();
  }
  /// Renderer of the first picture.
  [[nodiscard]] Renderer& renderer() { return *parts_.front().renderer; }

  /// Waits until the device is idle.
  void finish() const { device_->handle().waitIdle(); }

 private:
  struct Part {
    std::unique_ptr<Renderer> renderer;
    bool has_picture = false;
  };

  void record(std::uint32_t index, const std::vector<std::optional<Picture>>& pictures);
  void copy_pictures(vk::Image image) const;
  void copy_picture(vk::Image image, const gpu::Image& picture, const Place& place) const;
  void draw_gui(std::uint32_t index) const;
  void submit(std::uint32_t index);
  void make_framebuffers();
  [[nodiscard]] std::unique_ptr<GuiContext> make_gui(double scale) const;

  const gpu::Instance* instance_;
  const gpu::Device* device_;
  gpu::SwapChain chain_;
  vk::raii::RenderPass render_pass_;
  std::vector<Part> parts_;  ///< at least one
  std::vector<Place> places_;
  std::unique_ptr<GuiContext> gui_;
  std::vector<vk::raii::Framebuffer> framebuffers_;
  vk::raii::CommandPool pool_;
  vk::raii::CommandBuffers buffers_;
  vk::raii::Semaphore ready_;
  vk::raii::Fence done_;
};

}  // namespace pillarfield::viewer
