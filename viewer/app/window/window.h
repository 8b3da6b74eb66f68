#pragma once

#include <span>
#include <string>
#include <vector>

#include "viewer/app/input/input.h"
#include "viewer/gpu/instance.h"

struct GLFWwindow;

namespace pillarfield::viewer {

/// A window of the display, at first hidden, without anything that draws into it. One at a time, in
/// the main thread.
class Window {
 public:
  /// Throws Error that names --headless where there is no display.
  Window(const std::string& title, std::uint32_t width, std::uint32_t height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  Window(Window&&) = delete;
  Window& operator=(Window&&) = delete;

  /// What Vulkan needs to draw into it.
  [[nodiscard]] static std::span<const char* const> extensions();
  [[nodiscard]] vk::raii::SurfaceKHR make_surface(const gpu::Instance& instance) const;

  [[nodiscard]] vk::Extent2D size() const;  ///< pixels; 0 x 0 while it is minimised
  [[nodiscard]] double scale() const;       ///< of the display: 1, 1.5, 2, ...
  [[nodiscard]] bool closes() const;        ///< somebody wants it closed
  void show();

  void poll();                          ///< collects what happened
  void wait(double seconds);            ///< the same, once something has happened or then
  static void wake();                   ///< ends wait(); from any thread
  [[nodiscard]] static double now_s();  ///< the clock of ButtonEvent::time_s

  /// What was collected, and forgets it.
  [[nodiscard]] std::vector<InputEvent> take_events();

  /// Whether it must be drawn anew: it was uncovered, resized, or moved to another display.
  [[nodiscard]] bool take_damage();

 private:
  struct Callbacks;
  void listen();

  GLFWwindow* window_ = nullptr;
  std::vector<InputEvent> events_;
  /// As the last event had it: asked for, GLFW gives where the cursor is now, not where it was.
  Vec2 cursor_;
  bool damaged_ = true;
};

}  // namespace pillarfield::viewer
