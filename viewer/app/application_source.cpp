#include <fmt/format.h>

#include <utility>

#include "pillarfield/error.h"
#include "viewer/app/application.h"
#include "viewer/app/input/marks.h"
#include "viewer/app/panels/panels.h"

// The source of an Application: opening, showing and closing it, and what its threads report.

namespace pillarfield::viewer {
namespace {

/// True if the options set no view other than the whole skin.
bool asks_for_whole_skin(const Options& options) {
  return options.zoom == 1 && !options.centre_mm && !options.azimuth && !options.elevation;
}

}  // namespace

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
    state_.notice.fail(error.what());
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
  next.boxes = user_.boxes.on(source.skin);
  next.show_panels = state_.show_panels;
  next.folds_curves = state_.folds_curves;
  next.show_counters = state_.show_counters;
  load_follower_ = LoadFollower(next.player->live() != nullptr && !options_.range);
  next.view_is_fitted = asks_for_whole_skin(options_);
  state_ = std::move(next);
  source_was_shown_ = true;
  place_.source = &source;
  set_beside();
  arrange();
  state_.settings.view = first_view(
      options_, source, layout_of(place_.area.width, place_.area.height, state_.settings));
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
  held_.reset();
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

/// A sensor that fails leaves its picture; the failure of a file ends the program.
std::optional<ShownField> Application::taken_field() {
  try {
    return state_.player->take();
  } catch (const Error& error) {
    if (state_.player->live() == nullptr) throw;
    state_.notice.fail(error.what());
    redraws_.input(Window::now_s());
    return std::nullopt;
  }
}

void Application::take_beside() {
  if (state_.beside == nullptr) return;
  auto field = state_.beside->take();
  if (!field) return;
  state_.beside_field = std::move(*field);
  beside_is_new_ = true;
  redraws_.field();
}

/// Passes pins, boxes, selection and the state of the play head to the survey.
void Application::attend_survey() {
  std::vector<PillarRect> rects;
  for (const Pin& pin : state_.pins) rects.push_back(rect_of(pin));
  if (state_.selection && controls_.is_dragging()) return;
  for (const NamedBox& box : state_.boxes) rects.push_back(box.rect);
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
  LiveControl* const live = state_.player->live();
  if (live == nullptr) return;
  const LiveStatus status = live->status();
  if (std::exchange(live_messages_, status.messages) != status.messages && status.messages > 0) {
    state_.notice = status.message;
    redraws_.field();
  }
  if (status.health.since_frame_s > kSilentSeconds && !status.ended) redraws_.field();
}

}  // namespace pillarfield::viewer
