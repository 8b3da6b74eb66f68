#include "viewer/app/app.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "viewer/app/export/frame_writer.h"
#include "viewer/app/input/actions.h"
#include "viewer/app/input/controls.h"
#include "viewer/app/input/gui_input.h"
#include "viewer/app/loaded_source.h"
#include "viewer/app/window/draw_clock.h"
#include "viewer/app/window/gui.h"
#include "viewer/app/window/presenter.h"
#include "viewer/app/window/redraws.h"
#include "viewer/app/window/style.h"
#include "viewer/app/window/window.h"

namespace pillarfield::viewer {
namespace {

vk::Extent2D extent_of(const Viewport& box) {
  return {static_cast<std::uint32_t>(box.width), static_cast<std::uint32_t>(box.height)};
}

/// True if the options set no view other than the whole skin.
bool asks_for_whole_skin(const Options& options) {
  return options.zoom == 1 && !options.centre_mm && !options.azimuth && !options.elevation;
}

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The window and all that it needs; the order of members is the order of construction.
class Application {
 public:
  explicit Application(const Options& options);
  void run();

 private:
  [[nodiscard]] double scale() const {
    return options_.scale > 0 ? options_.scale : window_.scale();
  }
  [[nodiscard]] Command command() { return {state_, place_, pending_}; }
  void listen_to_player();

  void wait();
  void take_input();
  void route(const InputEvent& event);
  void take_newest_field();
  void arrange();
  bool fit_to_window();
  void draw();
  void draw_front_frame();
  void measure(double begin_s, bool new_picture);
  void watch_notice();

  void serve();
  void write_picture();
  void write_table();
  void begin_frames(FrameWriter::Kind kind);
  void continue_frames();
  [[nodiscard]] Pixels pixels() { return read_pixels(device_, presenter_.renderer().image()); }
  void finish();
  void print_statistics() const;

  const Options& options_;
  Window window_;
  std::atomic<double> produced_s_ = 0;  ///< time of the newest field, set by the player's thread
  LoadedSource loaded_;
  gpu::Instance instance_;
  vk::raii::SurfaceKHR surface_;
  gpu::Device device_;
  Presenter presenter_;

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
  std::optional<RenderSettings> drawn_settings_;
  bool field_is_new_ = false;
  double taken_s_ = 0;  ///< produced_s_ of the field on display
  double last_frame_s_ = 0;
};

Application::Application(const Options& options)
    : options_(options),
      window_(options.source.filename().string() + " – Pillarfield", options.width, options.height),
      loaded_(load_source(options, scale())),
      instance_(Window::extensions(), options.validate),
      surface_(window_.make_surface(instance_)),
      device_(instance_, {options.gpu, *surface_, !options.copy_fields}),
      presenter_(instance_, device_, *surface_, scale()) {
  state_.player = loaded_.player.get();
  state_.settings = loaded_.settings;
  state_.view_is_fitted = asks_for_whole_skin(options);
  place_.source = &state_.player->info();
  arrange();
  const Viewport plot = layout_of(place_.area.width, place_.area.height, state_.settings).plot;
  state_.settings.view = first_view(options, *place_.source, plot);
  listen_to_player();
}

void Application::listen_to_player() {
  state_.player->on_new_field([this] {
    produced_s_ = steady_s();
    Window::wake();
  });
}

void Application::run() {
  window_.show();
  if (options_.first_frame != 0) state_.player->seek(options_.first_frame);
  // After seek(): contacts are tracked from the first shown frame on.
  state_.player->set_contacts(state_.settings.contacts);
  if (!options_.paused) state_.player->play();
  while (!window_.closes() && !pending_.quit && !is_interrupted()) {
    wait();
    take_input();
    take_newest_field();
    if (redraws_.due(Window::now_s()) && fit_to_window()) draw();
    serve();
  }
  finish();
  if (options_.statistics) print_statistics();
}

/// Waits for events; briefly, since a signal does not end a wait.
void Application::wait() {
  constexpr double kLongestWaitS = 0.25;
  const bool minimised = window_.size().width == 0;
  const auto rest = redraws_.rest(Window::now_s());
  if (minimised) {
    window_.wait(kLongestWaitS);
  } else if (rest && *rest <= 0) {
    window_.poll();
  } else {
    window_.wait(std::min(rest.value_or(kLongestWaitS), kLongestWaitS));
  }
}

void Application::take_input() {
  const bool damaged = window_.take_damage();
  const auto events = window_.take_events();
  if (damaged || !events.empty()) redraws_.input(Window::now_s());
  presenter_.gui().use();
  arrange();
  for (const InputEvent& event : events) route(event);
}

/// Sends an event to the controls or to ImGui. Text input suppresses shortcuts; popups over the
/// field take the mouse.
void Application::route(const InputEvent& event) {
  const bool types = ImGui::GetIO().WantTextInput;
  const bool covered = GuiInput::has_open_list();
  if (const auto* key = std::get_if<KeyEvent>(&event)) {
    if (types || !key->pressed) gui_input_.take(event);
    if (covered && key->pressed) {
      GuiInput::close_lists();
    } else if (!types) {
      controls_.take(event, command());
    }
    return;
  }
  if (std::holds_alternative<TextEvent>(event)) {
    if (types) gui_input_.take(event);
    return;
  }
  const auto* const button = std::get_if<ButtonEvent>(&event);
  const bool presses = button != nullptr && button->pressed;
  if (presses && state_.show_help) {
    state_.show_help = false;
    return;
  }
  const auto* const wheel = std::get_if<WheelEvent>(&event);
  const bool in_field = wheel != nullptr && contains(place_.area, wheel->pixel) && !covered;
  if (!in_field) gui_input_.take(event);
  if (!covered || (button != nullptr && !presses)) controls_.take(event, command());
}

void Application::take_newest_field() {
  const double came_s = produced_s_;
  auto field = state_.player->take();
  if (!field) return;
  take_field(state_, std::move(*field));
  taken_s_ = came_s;
  field_is_new_ = true;
  redraws_.field();
}

/// Computes the layout for the current window.
void Application::arrange() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return;
  state_.settings.scale = scale();
  const Viewport before = place_.area;
  screen_ = divide(size.width, size.height, scale(), state_.show_panels);
  place_.area = screen_.field;
  const bool moved = before.width != place_.area.width || before.height != place_.area.height;
  if (moved && state_.view_is_fitted) reset_view(state_, place_);
}

bool Application::fit_to_window() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return false;
  arrange();
  const vk::Extent2D picture = extent_of(screen_.field);
  const bool fits = !presenter_.stale() && size == sized_for_ &&
                    picture == presenter_.renderer().image().size() &&
                    scale() == presenter_.gui().scale();
  if (fits) return true;
  sized_for_ = size;
  drawn_settings_.reset();
  return presenter_.resize(size, picture, scale());
}

void Application::draw() {
  const double begin_s = Window::now_s();
  if (state_.hovered && !controls_.is_dragging()) controls_.hover(command());
  draw_front_frame();
  const bool new_picture = state_.field && (field_is_new_ || drawn_settings_ != state_.settings);
  std::optional<Presenter::Picture> picture;
  if (new_picture) {
    picture.emplace(Presenter::Picture{*state_.field, *place_.source, state_.settings});
  }
  if (!presenter_.draw(picture ? &*picture : nullptr)) return;
  measure(begin_s, new_picture);
  if (new_picture) drawn_settings_ = state_.settings;
  field_is_new_ = false;
  watch_notice();
  if (writer_ != nullptr && writer_->wants_picture()) continue_frames();
}

void Application::draw_front_frame() {
  presenter_.gui().use();
  set_style(state_.settings.theme, scale());
  const double now_s = Window::now_s();
  gui_input_.begin_frame(now_s - last_frame_s_);
  last_frame_s_ = now_s;
  const vk::Extent2D size = presenter_.size();
  ImGui::GetIO().DisplaySize =
      ImVec2(static_cast<float>(size.width), static_cast<float>(size.height));
  ImGui::NewFrame();
  draw_gui(command(), screen_, device_.name());
  ImGui::Render();
}

void Application::measure(double begin_s, bool new_picture) {
  const double now_s = Window::now_s();
  std::optional<double> latency_ms;
  // The first field may precede on_new_field().
  if (new_picture && field_is_new_ && taken_s_ > 0) latency_ms = 1e3 * (steady_s() - taken_s_);
  clock_.add(now_s, 1e3 * (now_s - begin_s), latency_ms);
  state_.draw = clock_.lately(now_s);
  const FieldMemory& memory = presenter_.renderer().memory();
  state_.draw.in_place = memory.fields_in_place() > 0 && memory.bytes_copied() == 0;
  redraws_.drawn(now_s);
}

void Application::watch_notice() {
  const double now_s = Window::now_s();
  if (state_.notice != last_notice_) redraws_.notice(now_s);
  if (redraws_.notice_is_old(now_s)) {
    state_.notice.clear();
    redraws_.forget_notice();
    redraws_.field();
  }
  last_notice_ = state_.notice;
}

/// Performs the pending actions; an Error becomes a notice.
void Application::serve() {
  const PendingActions asked = std::exchange(pending_, PendingActions{.quit = pending_.quit});
  if (!state_.field) return;
  try {
    if (asked.picture) write_picture();
    if (asked.table) write_table();
    if (asked.sequence) begin_frames(FrameWriter::Kind::pictures);
    if (asked.video) begin_frames(FrameWriter::Kind::video);
  } catch (const Error& error) {
    state_.notice = error.what();
  }
  if (asked.stop && writer_ != nullptr) {
    writer_.reset();
    state_.notice = "stopped writing";
  }
  if (asked.picture || asked.table || asked.sequence || asked.video || asked.stop) {
    redraws_.input(Window::now_s());
  }
}

void Application::write_picture() {
  if (!drawn_settings_) return;
  const auto path = free_path(*place_.source, info_of(state_.settings.quantity).name, ".png");
  check_outputs({options_.source}, {{path, OutputKind::png}}, Replace::nothing);
  write_png(path, pixels(), Replace::nothing);
  state_.notice = "wrote " + path.string();
}

void Application::write_table() {
  const std::string frame = fmt::format("frame_{}", state_.field->index + 1);
  const auto path = free_path(*place_.source, frame, ".csv");
  check_outputs({options_.source}, {{path, OutputKind::forces}}, Replace::nothing);
  write_csv(path, *state_.field, visible_pillars(place_, state_.settings), Replace::nothing);
  state_.notice = "wrote " + path.string();
}

void Application::begin_frames(FrameWriter::Kind kind) {
  if (writer_ != nullptr) return;
  const std::string quantity = info_of(state_.settings.quantity).name;
  const auto path = kind == FrameWriter::Kind::video ? free_path(*place_.source, quantity, ".mp4")
                                                     : free_sequence_path(*place_.source, quantity);
  const PlannedOutput first =
      kind == FrameWriter::Kind::video
          ? PlannedOutput{path, OutputKind::video}
          : PlannedOutput{numbered(path, 1, place_.source->frames), OutputKind::png};
  check_outputs({options_.source}, {first}, Replace::nothing);
  const vk::Extent2D size = presenter_.renderer().image().size();
  writer_ = std::make_unique<FrameWriter>(state_, kind, path, size.width, size.height);
}

void Application::continue_frames() {
  try {
    if (writer_->add(pixels())) writer_.reset();
  } catch (const Error& error) {
    state_.notice = error.what();
    writer_.reset();
  }
  redraws_.field();
}

/// Releases imported memory of the player before the player is destroyed.
void Application::finish() {
  state_.player->on_new_field({});
  presenter_.finish();
  writer_.reset();
  presenter_.renderer().memory().forget();
  state_.field.reset();
}

void Application::print_statistics() const {
  const PlayerStatistics played = state_.player->statistics();
  fmt::print(R"({{"frames":{},"draw_ms_median":{:.3f},"latency_ms_median":{:.3f},"produced":{},)"
             R"("taken":{},"not_shown":{},"in_place":{},"field":[{},{},{},{}],)"
             R"("validation_messages":{}}})"
             "\n",
             clock_.frames(), clock_.draw_ms_median(), clock_.latency_ms_median(), played.produced,
             played.taken, played.not_shown, state_.draw.in_place, screen_.field.x, screen_.field.y,
             screen_.field.width, screen_.field.height, instance_.validation_messages());
}

}  // namespace

int run_window(const Options& options) {
  Application(options).run();
  return 0;
}

}  // namespace pillarfield::viewer
