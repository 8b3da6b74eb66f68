#pragma once

#include <atomic>
#include <chrono>
#include <memory>

#include "viewer/app/export/frame_writer.h"
#include "viewer/app/input/actions.h"
#include "viewer/app/input/controls.h"
#include "viewer/app/input/gui_input.h"
#include "viewer/app/load_range.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/source/loading.h"
#include "viewer/app/source/user_settings.h"
#include "viewer/app/window/gui.h"
#include "viewer/app/window/presenter.h"
#include "viewer/app/window/redraws.h"
#include "viewer/app/window/window.h"

namespace pillarfield::viewer {

[[nodiscard]] inline vk::Extent2D extent_of(const Viewport& box) {
  return {static_cast<std::uint32_t>(box.width), static_cast<std::uint32_t>(box.height)};
}

[[nodiscard]] inline double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The window and all that it needs; the order of members is the order of construction.
class Application {
 public:
  explicit Application(const Options& options);
  // NOLINTNEXTLINE(bugprone-exception-escape): without memory the program ends anyway
  ~Application() { close(); }
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;
  void run();

 private:
  [[nodiscard]] double scale() const {
    return options_.scale > 0 ? options_.scale : window_.scale();
  }
  [[nodiscard]] Command command() { return {state_, place_, pending_}; }
  [[nodiscard]] bool shows_source() const {
    return state_.player != nullptr && loading_ == nullptr && !at_start_;
  }

  void open(const std::string& source);
  void take_loaded();
  void show(LoadedSource loaded);
  void close();
  void set_beside();
  void listen();

  void wait();
  void take_input();
  void route(const InputEvent& event);
  void route_to_start_page(const InputEvent& event);
  void route_key(const KeyEvent& key);
  void show_start_page();
  void keep_boxes();
  [[nodiscard]] InputEvent in_first_half(InputEvent event) const;
  void take_newest_field();
  void take_beside();
  [[nodiscard]] bool is_in_step() const;
  [[nodiscard]] std::optional<ShownField> taken_field();
  void take_news();
  void attend_survey();
  void attend_sensor();
  void arrange();
  bool fit_to_window();
  void draw();
  void draw_front_frame();
  void draw_page();
  void begin_gui_frame();
  void measure(double begin_s, bool new_picture);
  void watch_notice();

  void serve();
  void serve_open();
  [[nodiscard]] std::filesystem::path new_file(const std::string& detail, const char* ending,
                                               OutputKind kind) const;
  void write_picture();
  void write_table();
  void begin_frames(FrameWriter::Kind kind);
  void continue_frames();
  void toggle_recording();
  void toggle_truth();
  [[nodiscard]] Pixels pixels();
  void print_statistics() const;

  Options options_;  ///< of the open source
  UserSettings user_;
  StartChoices choices_;
  bool at_start_ = false;  ///< the start page covers the source
  Window window_;
  std::atomic<double> produced_s_ = 0;  ///< time of the newest field, set by the player's thread
  std::atomic<bool> news_ = false;      ///< a thread has progressed
  gpu::Instance instance_;
  vk::raii::SurfaceKHR surface_;
  gpu::Device device_;
  Presenter presenter_;
  LoadedSource loaded_;
  std::unique_ptr<Loading> loading_;

  AppState state_;
  FieldPlace place_;
  Screen screen_;
  vk::Extent2D sized_for_;
  Controls controls_;
  GuiInput gui_input_;
  PendingActions pending_;
  std::unique_ptr<FrameWriter> writer_;

  Redraws redraws_;
  DrawClock clock_;
  std::string last_notice_;
  bool source_was_given_ = false;  ///< on the command line
  bool source_was_shown_ = false;
  std::uint64_t live_messages_ = 0;
  std::vector<PillarRect> measured_;  ///< rectangles that have curves
  std::optional<RenderSettings> drawn_settings_;
  LoadFollower load_follower_;
  std::optional<ShownField> held_;  ///< until the second source has its frame
  bool field_is_new_ = false;
  bool beside_is_new_ = false;
  double taken_s_ = 0;  ///< produced_s_ of the field on display
  double last_frame_s_ = 0;
};

}  // namespace pillarfield::viewer
