#include "viewer/app/window/window.h"

// GLFW declares Vulkan surfaces only if Vulkan is included first.
#include <GLFW/glfw3.h>

#include <cctype>
#include <optional>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

constexpr const char* kMend = "render to a file instead: --headless";

/// GLFW's description of the last error.
std::string last_failure() {
  const char* words = nullptr;
  if (glfwGetError(&words) == GLFW_NO_ERROR || words == nullptr) return "it cannot be opened";
  std::string text = words;
  while (!text.empty() && (text.back() == '.' || text.back() == '\n')) text.pop_back();
  return text;
}

[[noreturn]] void fail() {
  const std::string why = last_failure();
  glfwTerminate();
  throw Error("window", why, kMend);
}

Modifiers modifiers_of(int bits) {
  return {(bits & GLFW_MOD_SHIFT) != 0, (bits & GLFW_MOD_CONTROL) != 0};
}

/// The key by the keyboard's layout, so that Q is Q on AZERTY.
int key_by_layout(int key, int scancode) {
  if (key < GLFW_KEY_A || key > GLFW_KEY_Z) return key;
  const char* const name = glfwGetKeyName(key, scancode);
  if (name == nullptr || name[1] != '\0') return key;
  const int letter = std::toupper(static_cast<unsigned char>(name[0]));
  return letter >= GLFW_KEY_A && letter <= GLFW_KEY_Z ? letter : key;
}

std::optional<MouseButton> button_of(int button) {
  if (button == GLFW_MOUSE_BUTTON_LEFT) return MouseButton::left;
  if (button == GLFW_MOUSE_BUTTON_RIGHT) return MouseButton::right;
  if (button == GLFW_MOUSE_BUTTON_MIDDLE) return MouseButton::middle;
  return std::nullopt;
}

/// GLFW's cursor positions are in desktop units, which may differ from pixels.
Vec2 to_pixels(GLFWwindow* window, double x, double y) {
  int width = 0;
  int height = 0;
  int pixel_width = 0;
  int pixel_height = 0;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &pixel_width, &pixel_height);
  if (width <= 0 || height <= 0) return {x, y};
  return {x * pixel_width / width, y * pixel_height / height};
}

}  // namespace

/// GLFW's callbacks, which append events.
struct Window::Callbacks {
  static Window& of(GLFWwindow* window) {
    return *static_cast<Window*>(glfwGetWindowUserPointer(window));
  }
  static void key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
    const bool unusable = (modifiers & (GLFW_MOD_ALT | GLFW_MOD_SUPER)) != 0;
    of(window).events_.emplace_back(KeyEvent{key_by_layout(key, scancode), modifiers_of(modifiers),
                                             action != GLFW_RELEASE, unusable});
  }
  static void character(GLFWwindow* window, unsigned int character) {
    of(window).events_.emplace_back(TextEvent{character});
  }
  static void motion(GLFWwindow* window, double x, double y) {
    of(window).cursor_ = to_pixels(window, x, y);
    of(window).events_.emplace_back(MotionEvent{of(window).cursor_});
  }
  static void enter(GLFWwindow* window, int entered) {
    if (entered == GLFW_FALSE) of(window).events_.emplace_back(LeaveEvent{});
  }
  static void button(GLFWwindow* window, int button, int action, int modifiers) {
    const auto known = button_of(button);
    if (!known) return;
    of(window).events_.emplace_back(ButtonEvent{
        *known, action == GLFW_PRESS, modifiers_of(modifiers), of(window).cursor_, glfwGetTime()});
  }
  static void wheel(GLFWwindow* window, double /*x*/, double y) {
    of(window).events_.emplace_back(WheelEvent{y, of(window).cursor_});
  }
  static void drop(GLFWwindow* window, int count, const char** names) {
    of(window).drops_.assign(names, names + count);
  }
  static void damage(GLFWwindow* window) { of(window).damaged_ = true; }
  static void resize(GLFWwindow* window, int /*width*/, int /*height*/) { damage(window); }
  static void rescale(GLFWwindow* window, float /*x*/, float /*y*/) { damage(window); }
};

Window::Window(const std::string& title, std::uint32_t width, std::uint32_t height) {
  if (glfwInit() == GLFW_FALSE) fail();
  if (glfwVulkanSupported() == GLFW_FALSE) {
    glfwTerminate();
    throw Error("window", "no Vulkan driver can draw into windows",
                "install one, for instance mesa-vulkan-drivers");
  }
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height), title.c_str(),
                             nullptr, nullptr);
  if (window_ == nullptr) fail();
  glfwSetWindowSizeLimits(window_, 480, 320, GLFW_DONT_CARE, GLFW_DONT_CARE);
  listen();
}

void Window::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetKeyCallback(window_, Callbacks::key);
  glfwSetCharCallback(window_, Callbacks::character);
  glfwSetCursorPosCallback(window_, Callbacks::motion);
  glfwSetCursorEnterCallback(window_, Callbacks::enter);
  glfwSetMouseButtonCallback(window_, Callbacks::button);
  glfwSetScrollCallback(window_, Callbacks::wheel);
  glfwSetDropCallback(window_, Callbacks::drop);
  glfwSetWindowRefreshCallback(window_, Callbacks::damage);
  glfwSetFramebufferSizeCallback(window_, Callbacks::resize);
  glfwSetWindowContentScaleCallback(window_, Callbacks::rescale);
}

Window::~Window() {
  glfwDestroyWindow(window_);
  glfwTerminate();
}

std::span<const char* const> Window::extensions() {
  std::uint32_t count = 0;
  const char** const names = glfwGetRequiredInstanceExtensions(&count);
  return {names, count};
}

vk::raii::SurfaceKHR Window::make_surface(const gpu::Instance& instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  if (glfwCreateWindowSurface(*instance.handle(), window_, nullptr, &surface) != VK_SUCCESS) {
    throw Error("window", last_failure(), kMend);
  }
  return {instance.handle(), surface};
}

vk::Extent2D Window::size() const {
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  if (glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0) return {0, 0};
  return {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
}

double Window::scale() const {
  float x = 1;
  float y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  return static_cast<double>(x);
}

bool Window::closes() const { return glfwWindowShouldClose(window_) != 0; }

void Window::show() { glfwShowWindow(window_); }

void Window::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

// GLFW polls all windows; only one exists.
// NOLINTNEXTLINE(readability-convert-member-functions-to-static)
void Window::poll() { glfwPollEvents(); }

// NOLINTNEXTLINE(readability-convert-member-functions-to-static): as above
void Window::wait(double seconds) { glfwWaitEventsTimeout(seconds); }

void Window::wake() { glfwPostEmptyEvent(); }

double Window::now_s() { return glfwGetTime(); }

std::vector<InputEvent> Window::take_events() { return std::exchange(events_, {}); }

std::vector<std::string> Window::take_drops() { return std::exchange(drops_, {}); }

bool Window::take_damage() { return std::exchange(damaged_, false); }

}  // namespace pillarfield::viewer
