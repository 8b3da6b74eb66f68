#pragma once

#include <span>
#include <string>
#include <vector>

#include "viewer/app/input/input.h"
#include "viewer/gpu/instance.h"

struct GLFWwindow;

namespace pillarfield::viewer {

/// A window, at first hidden, without drawing. At most one exists, in the main thread.
class Window {
 public:
  /// Without a display throws Error that suggests --headless.
  Window(const std::string& title, std::uint32_t width, std::uint32_t height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  Window(Window&&) = delete;
  Window& operator=(Window&&) = delete;

  /// Vulkan instance extensions for the window.
  [[nodiscard]] static std::span<const char* const> extensions();
  [[nodiscard]] vk::raii::SurfaceKHR make_surface(const gpu::Instance& instance) const;

  [[nodiscard]] vk::Extent2D size() const;  ///< pixels; 0 x 0 while it is minimised
  [[nodiscard]] double scale() const;       ///< scale of the display: 1, 1.5, 2, ...
  [[nodiscard]] bool closes() const;        ///< the user asked to close it
  void show();
  void set_title(const std::string& title);

  void poll();                          ///< collects events
  void wait(double seconds);            ///< waits for an event or the timeout, then collects
  static void wake();                   ///< ends wait(); from any thread
  [[nodiscard]] static double now_s();  ///< the clock of ButtonEvent::time_s

  /// Returns and clears the collected events.
  [[nodiscard]] std::vector<InputEvent> take_events();

  /// Returns and clears the names of files dropped onto the window.
  [[nodiscard]] std::vector<std::string> take_drops();

  /// True if it must be redrawn: uncovered, resized, or moved to another display.
  [[nodiscard]] bool take_damage();

 private:
  struct Callbacks;
  void listen();

  GLFWwindow* window_ = nullptr;
  std::vector<InputEvent> events_;
  std::vector<std::string> drops_;
  /// Position of the last motion event; GLFW's query returns the current position.
  Vec2 cursor_;
  bool damaged_ = true;
};

}  // namespace pillarfield::viewer
