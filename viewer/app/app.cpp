#include "viewer/app/app.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/processor.h"
#include "viewer/app/export/file_writer.h"
#include "viewer/app/input/actions.h"
#include "viewer/app/input/gui_input.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/source/source_feed.h"
#include "viewer/app/source/user_settings.h"
#include "viewer/app/window/gui.h"
#include "viewer/app/window/presenter.h"
#include "viewer/app/window/redraws.h"
#include "viewer/app/window/style.h"
#include "viewer/app/window/window.h"

namespace pillarfield::viewer {
namespace {

/// The first use of OpenCL sets the environment, so it comes before all threads.
void prepare_devices() {
  try {
    static_cast<void>(list_devices());
  } catch (const Error&) {
    // Opening a device fails with the same error, where one is needed.
  }
}

/// True if the options set no view other than the whole skin.
bool asks_for_whole_skin(const Options& options) {
  return options.zoom == 1 && !options.centre_mm && !options.azimuth && !options.elevation;
}

Presenter::Place place_in_window(const Viewport& area) {
  return {{static_cast<int>(area.x), static_cast<int>(area.y)},
          {static_cast<std::uint32_t>(area.width), static_cast<std::uint32_t>(area.height)}};
}

/// The window and what it needs; the order of members is the order of construction.
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
    return state_.source.player != nullptr && feed_.loading() == nullptr && !at_start_;
  }

  // The source.
  void open(const std::string& source);
  void take_loaded();
  void show(LoadedSource loaded);
  void close();
  void take_news();

  // Input.
  void wait();
  void take_input();
  [[nodiscard]] bool takes_input();
  void route_to_start_page(const InputEvent& event);
  void serve();
  void serve_open();
  void show_start_page();

  // Drawing.
  bool fit_to_window();
  void arrange();
  void draw();
  void draw_source();
  void draw_page();
  void begin_gui_frame();
  void measure(double begin_s, bool new_picture);
  void watch_notice();
  [[nodiscard]] Pixels pixels() const;
  void print_statistics() const;

  Options options_;  ///< of the open source
  UserSettings user_;
  StartChoices choices_;
  bool at_start_ = false;  ///< the start page covers the source
  Window window_;
  gpu::Instance instance_;
  vk::raii::SurfaceKHR surface_;
  gpu::Device device_;
  Presenter presenter_;

  AppState state_;
  SourceFeed feed_{state_, Window::wake};
  FileWriter writer_{state_};
  FieldPlace place_;
  Screen screen_;
  vk::Extent2D sized_for_;
  Controls controls_;
  GuiInput gui_input_;
  PendingActions pending_;

  Redraws redraws_;
  DrawClock clock_;
  bool in_place_ = false;  ///< the device reads the solver's memory without a copy
  std::string last_notice_;
  bool source_was_given_ = false;  ///< on the command line
  bool source_was_shown_ = false;
  double chosen_s_ = -1;  ///< time when a source was chosen on the start page
  std::optional<RenderSettings> drawn_settings_;
  double last_frame_s_ = 0;
};

Application::Application(const Options& options)
    : options_(options),
      choices_{user_.recent(), scenes_at_hand()},
      window_("Pillarfield", options.width, options.height),
      instance_(Window::extensions(), options.validate),
      surface_(window_.make_surface(instance_)),
      device_(instance_, {options.gpu, *surface_, !options.copy_fields}),
      presenter_(instance_, device_, *surface_, scale()) {
  state_.look.settings.theme = options.look.theme;
}

void Application::run() {
  window_.show();
  source_was_given_ = !options_.source.empty();
  if (source_was_given_) open(options_.source.string());
  while (!window_.closes() && !pending_.quit && !is_interrupted()) {
    wait();
    take_loaded();
    take_input();
    take_news();
    if (redraws_.due(Window::now_s()) && fit_to_window()) draw();
    serve();
  }
  user_.save();
  if (options_.statistics) print_statistics();
  feed_.give_up();
}

/// Opens Options::source, or a source that the user chose.
void Application::open(const std::string& source) {
  options_.source = source;
  feed_.open(options_, scale());
  redraws_.input(Window::now_s());
}

void Application::take_loaded() {
  try {
    if (auto loaded = feed_.take_loaded()) show(std::move(*loaded));
  } catch (const Error& error) {
    if (state_.source.player == nullptr && source_was_given_) throw;
    state_.window.notice.fail(error.what());
    gui_input_.clear();  // It was meant for that source.
    redraws_.input(Window::now_s());
  }
}

void Application::show(LoadedSource loaded) {
  close();
  AppState next;
  next.source = std::move(loaded.source);
  const SourceInfo& source = next.source.player->info();
  fmt::print(stderr, "{}", warning_lines(source));
  user_.add_recent(next.source.name);
  next.look.settings = loaded.settings;
  if (source_was_shown_) next.look.settings.theme = state_.look.settings.theme;
  next.look.view_is_fitted = asks_for_whole_skin(options_);
  next.window.show_panels = state_.window.show_panels;
  next.window.folds_curves = state_.window.folds_curves;
  state_ = std::move(next);
  pending_ = {};
  source_was_shown_ = true;
  place_.source = &source;
  arrange();
  RenderSettings& settings = state_.look.settings;
  settings.view =
      first_view(options_, source, layout_of(place_.area.width, place_.area.height, settings));
  drawn_settings_.reset();
  feed_.begin(options_);
  redraws_.input(Window::now_s());
}

void Application::close() {
  writer_.stop();
  presenter_.clear();
  feed_.end();
}

/// Progress of other threads, and new fields.
void Application::take_news() {
  bool news = feed_.take_news();
  if (shows_source()) news |= feed_.take_fields();
  if (news) redraws_.field();
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
  auto events = window_.take_events();
  std::erase_if(events, [&](const InputEvent& event) {  // A double click opens a source once.
    const auto* const button = std::get_if<ButtonEvent>(&event);
    return button != nullptr && button->time_s < chosen_s_ + kDoubleClickSeconds;
  });
  gui_input_.add(events);
  if (damaged || !gui_input_.is_empty()) redraws_.input(Window::now_s());
  presenter_.gui().use();
  arrange();
  while (takes_input()) {
    const auto event = gui_input_.next();
    if (!event) break;
    if (shows_source()) {
      route(*event, command(), screen_.field, controls_);
    } else {
      route_to_start_page(*event);
    }
  }
  const auto drops = window_.take_drops();
  if (!drops.empty()) pending_.open = drops.front();
}

/// False while input waits: for a source, in which only Q acts, or its picture.
bool Application::takes_input() {
  if (feed_.loading() != nullptr || (shows_source() && !state_.source.field)) {
    pending_.quit |= gui_input_.has_pressed(GLFW_KEY_Q);
    return false;
  }
  return !shows_source() || drawn_settings_.has_value();
}

void Application::route_to_start_page(const InputEvent& event) {
  GuiInput::take(event);
  const auto* const key = std::get_if<KeyEvent>(&event);
  if (key == nullptr || !key->pressed || key->unusable || GuiInput::wants_text()) return;
  if (key->key == GLFW_KEY_ESCAPE && state_.source.player != nullptr) at_start_ = false;
  if (key->key == GLFW_KEY_Q) pending_.quit = true;
}

/// Performs the pending actions, those on a picture once there is one; an Error becomes a notice.
void Application::serve() {
  serve_open();
  if (std::exchange(pending_.start, false)) show_start_page();
  if (!state_.source.field || !shows_source() || !drawn_settings_) return;
  const PendingActions asked = std::exchange(pending_, {});
  pending_.quit = asked.quit;
  if (!asked.anything()) return;
  writer_.serve(asked, place_, [this] { return pixels(); });
  redraws_.input(Window::now_s());
}

void Application::serve_open() {
  if (pending_.open.empty()) return;
  feed_.give_up();  // It may wait for a sensor for ever.
  options_.first_frame = 0;
  at_start_ = false;
  chosen_s_ = Window::now_s();
  open(std::exchange(pending_.open, {}));
}

/// Covers the source, which goes on, by the start page.
void Application::show_start_page() {
  at_start_ = true;
  choices_.recent = user_.recent();
  state_.window.notice.clear();
}

bool Application::fit_to_window() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return false;
  arrange();
  std::optional<Presenter::Place> place;
  if (shows_source()) place = place_in_window(place_.area);
  const bool fits = !presenter_.stale() && size == sized_for_ && place == presenter_.place() &&
                    scale() == presenter_.gui().scale();
  if (fits) return true;
  sized_for_ = size;
  drawn_settings_.reset();
  return presenter_.resize(size, place, scale());
}

/// Computes the layout for the current window.
void Application::arrange() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return;
  state_.look.settings.scale = scale();
  const Viewport before = place_.area;
  screen_ = divide(size.width, size.height, scale(), sides_of(state_));
  place_.area = screen_.field;
  const bool moved = before.width != place_.area.width || before.height != place_.area.height;
  if (moved && state_.look.view_is_fitted && state_.source.player != nullptr) {
    reset_view(state_, place_);
  }
}

void Application::draw() {
  if (shows_source()) return draw_source();
  draw_page();
  static_cast<void>(presenter_.draw(std::nullopt));
  redraws_.drawn(Window::now_s());
}

void Application::draw_source() {
  const double begin_s = Window::now_s();
  const ShownSource& source = state_.source;
  const RenderSettings& settings = state_.look.settings;
  if (state_.marks.hovered && !controls_.is_dragging()) controls_.hover(command());
  begin_gui_frame();
  draw_gui(command(), screen_, device_.name());
  ImGui::Render();
  const bool new_picture = source.field && (feed_.has_field() || drawn_settings_ != settings);
  std::optional<Presenter::Picture> picture;
  if (new_picture) picture.emplace(Presenter::Picture{*source.field, *place_.source, settings});
  if (!presenter_.draw(picture)) return;
  // Not before there is something to see, for who waits for it.
  if (new_picture && !drawn_settings_) window_.set_title(place_.source->name + " – Pillarfield");
  measure(begin_s, new_picture);
  if (new_picture) drawn_settings_ = settings;
  feed_.drawn();
  watch_notice();
  if (writer_.go_on([this] { return pixels(); })) redraws_.field();
}

/// The page without a source.
void Application::draw_page() {
  begin_gui_frame();
  const vk::Extent2D size = presenter_.size();
  const Viewport all{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
  if (const Loading* const loading = feed_.loading()) {
    loading_page(loading->options().source.filename().string(), loading->message(), all);
  } else {
    const std::string chosen = start_page(choices_, all, state_.window.notice, scale());
    if (!chosen.empty()) pending_.open = chosen;
  }
  ImGui::Render();
}

void Application::begin_gui_frame() {
  presenter_.gui().use();
  set_style(state_.look.settings.theme, scale());
  const double now_s = Window::now_s();
  gui_input_.begin_frame(now_s - last_frame_s_);
  last_frame_s_ = now_s;
  const vk::Extent2D size = presenter_.size();
  ImGui::GetIO().DisplaySize =
      ImVec2(static_cast<float>(size.width), static_cast<float>(size.height));
  ImGui::NewFrame();
}

void Application::measure(double begin_s, bool new_picture) {
  const double now_s = Window::now_s();
  clock_.add(1e3 * (now_s - begin_s), new_picture ? feed_.latency_ms() : std::nullopt);
  const FieldMemory& memory = presenter_.renderer().memory();
  in_place_ = memory.fields_in_place() > 0 && memory.bytes_copied() == 0;
  redraws_.drawn(now_s);
}

void Application::watch_notice() {
  const double now_s = Window::now_s();
  Notice& notice = state_.window.notice;
  if (notice != last_notice_) redraws_.notice(now_s);
  if (redraws_.notice_is_old(now_s)) {
    notice.clear();
    redraws_.forget_notice();
    redraws_.field();
  }
  last_notice_.assign(notice);
}

Pixels Application::pixels() const { return read_pixels(device_, presenter_.image()); }

void Application::print_statistics() const {
  const Player* const player = state_.source.player.get();
  const PlayerStatistics played = player == nullptr ? PlayerStatistics{} : player->statistics();
  fmt::print(R"({{"frames":{},"draw_ms_median":{:.3f},"latency_ms_median":{:.3f},"produced":{},)"
             R"("taken":{},"not_shown":{},"in_place":{},"field":[{},{},{},{}],)"
             R"("validation_messages":{}}})"
             "\n",
             clock_.frames(), clock_.draw_ms_median(), clock_.latency_ms_median(), played.produced,
             played.taken, played.not_shown, in_place_, screen_.field.x, screen_.field.y,
             screen_.field.width, screen_.field.height, instance_.validation_messages());
}

}  // namespace

int run_window(const Options& options) {
  prepare_devices();
  Application(options).run();
  return 0;
}

bool is_device_lost(const std::exception& error) {
  return dynamic_cast<const vk::DeviceLostError*>(&error) != nullptr;
}

}  // namespace pillarfield::viewer
