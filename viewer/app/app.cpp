#include "viewer/app/app.h"

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <memory>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/processor.h"
#include "viewer/app/export/frame_writer.h"
#include "viewer/app/input/actions.h"
#include "viewer/app/input/controls.h"
#include "viewer/app/input/gui_input.h"
#include "viewer/app/input/pins.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/start_page.h"
#include "viewer/app/source/loading.h"
#include "viewer/app/source/user_settings.h"
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

Presenter::Place place_in_window(const Viewport& area) {
  return {{static_cast<int>(area.x), static_cast<int>(area.y)}, extent_of(area)};
}

/// The first use of OpenCL sets the environment, so it comes before all threads.
void prepare_devices() {
  try {
    static_cast<void>(list_devices());
  } catch (const Error&) {
    // Opening a device fails with the same error, where one is needed.
  }
}

/// The window and all that it needs; the order of members is the order of construction.
class Application {
 public:
  explicit Application(const Options& options);
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
    return state_.player != nullptr && loading_ == nullptr;
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
  [[nodiscard]] InputEvent in_first_half(InputEvent event) const;
  void take_newest_field();
  void take_beside();
  [[nodiscard]] std::optional<ShownField> taken_field();
  void fit_first_load();
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
  const StartChoices choices_;
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
  bool fits_first_load_ = false;  ///< of a sensor
  bool field_is_new_ = false;
  bool beside_is_new_ = false;
  double taken_s_ = 0;  ///< produced_s_ of the field on display
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
  state_.settings.theme = options.theme;
  state_.panels = user_.panels;
}

/// Opens Options::source, or a source that the user chose.
void Application::open(const std::string& source) {
  options_.source = source;
  state_.notice.clear();
  loading_ = std::make_unique<Loading>(options_, scale(), [this] {
    news_ = true;
    Window::wake();
  });
  redraws_.input(Window::now_s());
}

void Application::take_loaded() {
  if (loading_ == nullptr) return;
  try {
    if (auto loaded = loading_->take()) {
      loading_.reset();
      show(std::move(*loaded));
    }
  } catch (const Error& error) {
    loading_.reset();
    if (state_.player == nullptr && source_was_given_) throw;
    state_.notice = error.what();
    redraws_.input(Window::now_s());
  }
}

void Application::show(LoadedSource loaded) {
  close();
  loaded_ = std::move(loaded);
  const SourceInfo& source = loaded_.player->info();
  fmt::print(stderr, "{}", warning_lines(source));
  user_.add_recent(loaded_.name);
  AppState next;
  next.player = loaded_.player.get();
  next.curves = loaded_.curves.get();
  next.survey = loaded_.survey.get();
  next.has_truth = static_cast<bool>(loaded_.open_truth);
  next.settings = loaded_.settings;
  if (source_was_shown_) next.settings.theme = state_.settings.theme;
  next.panels = std::move(state_.panels);
  next.show_panels = state_.show_panels;
  next.show_counters = state_.show_counters;
  fits_first_load_ = next.player->live() != nullptr && !options_.range;
  next.view_is_fitted = asks_for_whole_skin(options_);
  state_ = std::move(next);
  source_was_shown_ = true;
  place_.source = &source;
  set_beside();
  arrange();
  const Viewport plot = layout_of(place_.area.width, place_.area.height, state_.settings).plot;
  state_.settings.view = first_view(options_, source, plot);
  drawn_settings_.reset();
  listen();
  if (options_.first_frame != 0) state_.player->seek(options_.first_frame);
  // After seek(): contacts are tracked from the first shown frame on.
  state_.player->set_contacts(state_.settings.contacts);
  if (!options_.paused) state_.player->play();
  redraws_.input(Window::now_s());
}

/// Releases the memory of fields before their players.
void Application::close() {
  writer_.reset();
  if (loaded_.player != nullptr) loaded_.player->on_new_field({});
  if (loaded_.beside != nullptr) loaded_.beside->on_new_field({});
  if (loaded_.survey != nullptr) loaded_.survey->on_progress({});
  presenter_.clear();
  state_.field.reset();
  state_.beside_field.reset();
  state_.player = state_.beside = nullptr;
  state_.curves = nullptr;
  state_.survey = nullptr;
  measured_.clear();
  loaded_ = {};
}

void Application::set_beside() {
  state_.beside = loaded_.beside.get();
  state_.beside_is_truth = loaded_.beside_is_truth;
  if (state_.beside == nullptr) return;
  state_.beside->set_contacts(state_.settings.contacts);
  state_.beside->on_new_field([this] {
    news_ = true;
    Window::wake();
  });
}

void Application::listen() {
  state_.player->on_new_field([this] {
    produced_s_ = steady_s();
    Window::wake();
  });
  if (loaded_.survey == nullptr) return;
  loaded_.survey->on_progress([this] {
    news_ = true;
    Window::wake();
  });
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
    take_newest_field();
    if (redraws_.due(Window::now_s()) && fit_to_window()) draw();
    serve();
  }
  user_.panels = state_.panels;
  user_.save();
  if (options_.statistics) print_statistics();
  loading_.reset();
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
  const auto drops = window_.take_drops();
  if (!drops.empty()) pending_.open = drops.front();
}

/// Sends an event to the controls or to ImGui. Text input suppresses shortcuts; popups and panels
/// over the field take the mouse.
void Application::route(const InputEvent& event) {
  if (!shows_source()) {
    gui_input_.take(event);
    const auto* const key = std::get_if<KeyEvent>(&event);
    const bool quits = key != nullptr && key->pressed && key->key == GLFW_KEY_Q;
    if (quits && !ImGui::GetIO().WantTextInput) pending_.quit = true;
    return;
  }
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
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const bool over_panel =
      !controls_.is_dragging() && covers(state_.panels, {mouse.x, mouse.y}, scale());
  const auto* const wheel = std::get_if<WheelEvent>(&event);
  const bool in_field =
      wheel != nullptr && contains(screen_.field, wheel->pixel) && !covered && !over_panel;
  if (!in_field) gui_input_.take(event);
  if (over_panel && !std::holds_alternative<MotionEvent>(event)) return;
  if (!covered || (button != nullptr && !presses)) {
    controls_.take(over_panel ? LeaveEvent{} : in_first_half(event), command());
  }
}

/// The second picture has the view of the first, so a place in it means the one in the first.
InputEvent Application::in_first_half(InputEvent event) const {
  if (state_.beside == nullptr) return event;
  const Viewport second = second_half(screen_.field, scale());
  std::visit(
      [&](auto& each) {
        if constexpr (requires { each.pixel; }) {
          if (contains(second, each.pixel)) each.pixel.x -= second.x - screen_.field.x;
        }
      },
      event);
  return event;
}

void Application::take_newest_field() {
  if (!shows_source()) return;
  take_beside();
  const double came_s = produced_s_;
  auto field = taken_field();
  if (!field) return;
  take_field(state_, std::move(*field));
  if (fits_first_load_) fit_first_load();
  if (state_.beside != nullptr) state_.beside->seek(state_.field->index);
  taken_s_ = came_s;
  field_is_new_ = true;
  redraws_.field();
}

/// A sensor that fails leaves its picture; the failure of a file ends the program.
std::optional<ShownField> Application::taken_field() {
  try {
    return state_.player->take();
  } catch (const Error& error) {
    if (state_.player->live() == nullptr) throw;
    state_.notice = error.what();
    redraws_.input(Window::now_s());
    return std::nullopt;
  }
}

/// Ranges of a sensor, by the first frame with a load.
void Application::fit_first_load() {
  const float most = largest(Quantity::normal, *state_.field);
  if (!(most > 0)) return;
  fits_first_load_ = false;
  const Range range = fitting_range(Quantity::normal, 2 * most);
  RenderSettings& settings = state_.settings;
  settings.full_force_n = settings.full_shear_n = static_cast<double>(most) / 2;
  settings.relief_full_n = static_cast<double>(range.high);
  if (settings.quantity == Quantity::normal) set_range(state_, range);
}

void Application::take_beside() {
  if (state_.beside == nullptr) return;
  auto field = state_.beside->take();
  if (!field) return;
  state_.beside_field = std::move(*field);
  beside_is_new_ = true;
  redraws_.field();
}

/// Progress of other threads, and of a sensor without frames.
void Application::take_news() {
  if (news_.exchange(false)) redraws_.field();
  if (!shows_source()) return;
  attend_survey();
  attend_sensor();
}

/// Passes pins, selection and the state of the play head to the survey.
void Application::attend_survey() {
  std::vector<PillarRect> rects;
  for (const Pin& pin : state_.pins) rects.push_back(rect_of(pin));
  if (state_.selection && controls_.is_dragging()) return;
  if (state_.selection) rects.push_back(state_.selection->rect);
  if (rects != measured_) {
    loaded_.curves->set_rects(rects);
    if (loaded_.survey != nullptr) loaded_.survey->look_again();
    measured_ = std::move(rects);
  }
  if (loaded_.survey == nullptr) return;
  const PlayerState player = state_.player->state();
  loaded_.survey->set_busy(player.playing);
  loaded_.survey->set_follow(player.follows);
}

void Application::attend_sensor() {
  const LiveControl* const live = state_.player->live();
  if (live == nullptr) return;
  const LiveStatus status = live->status();
  if (std::exchange(live_messages_, status.messages) != status.messages && status.messages > 0) {
    state_.notice = status.message;
    redraws_.field();
  }
  if (status.silent_s > kSilentSeconds && !status.ended) redraws_.field();
}

/// Computes the layout for the current window.
void Application::arrange() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return;
  state_.settings.scale = scale();
  state_.settings.colour_bar = state_.beside == nullptr;
  const Viewport before = place_.area;
  screen_ = divide(size.width, size.height, scale(), state_.show_panels ? &state_.panels : nullptr);
  place_.area = state_.beside != nullptr ? first_half(screen_.field, scale()) : screen_.field;
  const bool moved = before.width != place_.area.width || before.height != place_.area.height;
  if (moved && state_.view_is_fitted && state_.player != nullptr) reset_view(state_, place_);
}

bool Application::fit_to_window() {
  const vk::Extent2D size = window_.size();
  if (size.width == 0 || size.height == 0) return false;
  arrange();
  std::vector<Presenter::Place> places;
  if (shows_source()) places.push_back(place_in_window(place_.area));
  if (shows_source() && state_.beside != nullptr) {
    places.push_back(place_in_window(second_half(screen_.field, scale())));
  }
  const bool fits = !presenter_.stale() && size == sized_for_ && places == presenter_.places() &&
                    scale() == presenter_.gui().scale();
  if (fits) return true;
  sized_for_ = size;
  drawn_settings_.reset();
  return presenter_.resize(size, places, scale());
}

void Application::draw() {
  const double begin_s = Window::now_s();
  if (!shows_source()) {
    draw_page();
    static_cast<void>(presenter_.draw({}));
    redraws_.drawn(Window::now_s());
    return;
  }
  if (state_.hovered && !controls_.is_dragging()) controls_.hover(command());
  draw_front_frame();
  const bool new_settings = drawn_settings_ != state_.settings;
  const bool new_picture = state_.field && (field_is_new_ || new_settings);
  RenderSettings beside_settings = state_.settings;
  beside_settings.colour_bar = true;
  std::vector<std::optional<Presenter::Picture>> pictures(presenter_.places().size());
  if (new_picture) {
    pictures[0].emplace(Presenter::Picture{*state_.field, *place_.source, state_.settings});
  }
  if (pictures.size() > 1 && state_.beside_field && (beside_is_new_ || new_settings)) {
    pictures[1].emplace(
        Presenter::Picture{*state_.beside_field, state_.beside->info(), beside_settings});
  }
  if (!presenter_.draw(pictures)) return;
  // Not before there is something to see, for who waits for it.
  if (new_picture && !drawn_settings_) window_.set_title(place_.source->name + " – Pillarfield");
  measure(begin_s, new_picture);
  if (new_picture) drawn_settings_ = state_.settings;
  field_is_new_ = false;
  beside_is_new_ = false;
  watch_notice();
  if (writer_ != nullptr && writer_->wants_picture()) continue_frames();
}

void Application::draw_front_frame() {
  begin_gui_frame();
  draw_gui(command(), screen_, device_.name());
  ImGui::Render();
}

/// The page without a source.
void Application::draw_page() {
  begin_gui_frame();
  const vk::Extent2D size = presenter_.size();
  const Viewport all{0, 0, static_cast<double>(size.width), static_cast<double>(size.height)};
  if (loading_ != nullptr) {
    const std::string name = loading_->options().source.filename().string();
    loading_page(name, loading_->message(), all);
  } else if (const std::string chosen = start_page(choices_, all, state_.notice, scale());
             !chosen.empty()) {
    pending_.open = chosen;
  }
  ImGui::Render();
}

void Application::begin_gui_frame() {
  presenter_.gui().use();
  set_style(state_.settings.theme, scale());
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
  std::optional<double> latency_ms;
  // From the arrival at a sensor, else from the solved field; the first may precede on_new_field().
  if (new_picture && field_is_new_ && state_.field->arrived) {
    latency_ms = 1e3 * (steady_s() - std::chrono::duration<double>(*state_.field->arrived).count());
  } else if (new_picture && field_is_new_ && taken_s_ > 0) {
    latency_ms = 1e3 * (steady_s() - taken_s_);
  }
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
  serve_open();
  const PendingActions asked = std::exchange(pending_, PendingActions{});
  pending_.quit = asked.quit;
  if (!state_.field || !shows_source()) return;
  try {
    if (asked.picture) write_picture();
    if (asked.table) write_table();
    if (asked.sequence) begin_frames(FrameWriter::Kind::pictures);
    if (asked.video) begin_frames(FrameWriter::Kind::video);
    if (asked.record) toggle_recording();
    if (asked.truth) toggle_truth();
  } catch (const Error& error) {
    state_.notice = error.what();
  }
  if (asked.stop && writer_ != nullptr) {
    writer_.reset();
    state_.notice = "stopped writing";
  }
  if (asked.picture || asked.table || asked.sequence || asked.video || asked.stop || asked.record ||
      asked.truth) {
    redraws_.input(Window::now_s());
  }
}

void Application::serve_open() {
  if (pending_.open.empty() || loading_ != nullptr) return;
  options_.beside.clear();
  options_.truth = false;
  options_.first_frame = 0;
  open(std::exchange(pending_.open, {}));
}

void Application::toggle_recording() {
  LiveControl* const live = state_.player->live();
  if (live == nullptr) {
    throw Error(place_.source->name, "only a sensor can be recorded", "open a live source");
  }
  if (!live->status().recording.empty()) return live->stop_recording();
  const auto path = free_path(*place_.source, "recording", ".h5");
  live->record(path);
  state_.notice = "recording " + path.string();
}

void Application::toggle_truth() {
  if (loaded_.beside != nullptr) {
    loaded_.beside->on_new_field({});
    presenter_.clear();
    state_.beside_field.reset();
    loaded_.beside.reset();
    loaded_.beside_is_truth = false;
  } else {
    show_truth(loaded_);
    loaded_.beside->seek(state_.field->index);
  }
  set_beside();
  drawn_settings_.reset();
}

/// All pictures, side by side.
Pixels Application::pixels() {
  Pixels all = read_pixels(device_, presenter_.image(0));
  for (std::size_t i = 1; i < presenter_.places().size(); ++i) {
    all = side_by_side(all, read_pixels(device_, presenter_.image(i)));
  }
  return all;
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
  if (state_.player->live() != nullptr) {
    throw Error(place_.source->name, "a sensor has no last frame to write", "record it");
  }
  const std::string quantity = info_of(state_.settings.quantity).name;
  const auto path = kind == FrameWriter::Kind::video ? free_path(*place_.source, quantity, ".mp4")
                                                     : free_sequence_path(*place_.source, quantity);
  const PlannedOutput first =
      kind == FrameWriter::Kind::video
          ? PlannedOutput{path, OutputKind::video}
          : PlannedOutput{numbered(path, 1, place_.source->frames), OutputKind::png};
  check_outputs({options_.source}, {first}, Replace::nothing);
  const vk::Extent2D size = extent_of(screen_.field);
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

void Application::print_statistics() const {
  const PlayerStatistics played =
      state_.player == nullptr ? PlayerStatistics{} : state_.player->statistics();
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
  prepare_devices();
  Application(options).run();
  return 0;
}

}  // namespace pillarfield::viewer
