#include "viewer/app/source/source_feed.h"

#include <chrono>
#include <utility>

#include "pillarfield/error.h"
#include "viewer/app/input/actions.h"

namespace pillarfield::viewer {
namespace {

double feed_now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Loading::Loading(Options options, double scale, std::function<void()> wake)
    : options_(std::move(options)),
      wake_(std::move(wake)),
      thread_([this, scale] { run(scale); }) {}

Loading::~Loading() {
  stopping_ = true;
  thread_.join();
}

std::string Loading::message() const {
  const std::scoped_lock lock(mutex_);
  return message_;
}

std::optional<LoadedSource> Loading::take() {
  const std::scoped_lock lock(mutex_);
  if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
  return std::exchange(loaded_, std::nullopt);
}

void Loading::run(double scale) {
  try {
    LoadedSource loaded =
        load_source(options_, scale, [this](const std::string& words) { tell(words); });
    const std::scoped_lock lock(mutex_);
    loaded_ = std::move(loaded);
  } catch (...) {
    const std::scoped_lock lock(mutex_);
    failed_ = std::current_exception();
  }
  wake_();
}

void Loading::tell(const std::string& words) {
  if (stopping_) throw Error(options_.source.string(), "interrupted", "open it again");
  {
    const std::scoped_lock lock(mutex_);
    if (message_ == words) return;
    message_ = words;
  }
  wake_();
}

void LoadFollower::forget() {
  load_ = {};
  since_ = std::chrono::steady_clock::now().time_since_epoch();
}

void LoadFollower::take_field(AppState& state) {
  if (!follows_) return;
  const Skin& skin = state.source.player->info().skin;
  RenderSettings& settings = state.look.settings;
  if (quantity_ == settings.quantity && range_ != settings.range) follows_ = false;
  const ShownField& field = *state.source.field;
  if (field.arrived && *field.arrived < since_) return;
  const auto load = load_.add(field.time_s, largest(Quantity::normal, field, skin));
  if (load && follows_ && !state.look.fit_each_field) {
    const float most = 1.2F * *load;
    const Range range = fitting_range(Quantity::normal, most);
    settings.full_force_n = settings.full_shear_n = static_cast<double>(*load) / 2;
    settings.relief_full_n = static_cast<double>(range.high);
    if (settings.quantity == Quantity::normal) set_range(state, range);
    if (settings.quantity == Quantity::pressure) {
      set_range(state, fitting_range(Quantity::pressure, most * kpa_per_newton(skin)));
    }
  }
  quantity_ = settings.quantity;
  range_ = settings.range;
}

void SourceFeed::tell() {
  news_ = true;
  wake_();
}

void SourceFeed::open(const Options& options, double scale) {
  state_->window.notice.clear();
  loading_ = std::make_unique<Loading>(options, scale, [this] { tell(); });
}

std::optional<LoadedSource> SourceFeed::take_loaded() {
  if (loading_ == nullptr) return std::nullopt;
  try {
    auto loaded = loading_->take();
    if (loaded) loading_.reset();
    return loaded;
  } catch (const Error&) {
    loading_.reset();
    throw;
  }
}

void SourceFeed::begin(const Options& options) {
  ShownSource& source = state_->source;
  load_follower_ = LoadFollower(source.player->live() != nullptr && !options.range);
  source.player->on_new_field([this] {
    produced_s_ = feed_now_s();
    wake_();
  });
  if (source.survey != nullptr) source.survey->on_progress([this] { tell(); });
  if (options.first_frame != 0) source.player->seek(options.first_frame);
  // After seek(): contacts are tracked from the first shown frame on.
  source.player->set_contacts(state_->look.settings.contacts);
  if (!options.paused) source.player->play();
}

void SourceFeed::end() {
  ShownSource& source = state_->source;
  if (source.player != nullptr) source.player->on_new_field({});
  if (source.survey != nullptr) source.survey->on_progress({});
  source.field.reset();
  source = {};
}

bool SourceFeed::take_fields() {
  attend_survey();
  const bool message = attend_sensor();
  return take_field() || message;
}

bool SourceFeed::take_field() {
  taken_s_ = produced_s_;
  try {
    auto field = state_->source.player->take();
    if (!field) return false;
    viewer::take_field(*state_, *std::move(field));
  } catch (const Error& error) {  // A sensor leaves its picture; a file ends the program.
    if (state_->source.player->live() == nullptr) throw;
    state_->window.notice.fail(error.what());
    return true;
  }
  load_follower_.take_field(*state_);
  return field_is_new_ = true;
}

std::optional<double> SourceFeed::latency_ms() const {
  if (!field_is_new_) return std::nullopt;
  // on_new_field() may not have been called yet.
  const auto& arrived = state_->source.field->arrived;
  const double since_s = arrived ? std::chrono::duration<double>(*arrived).count() : taken_s_;
  return since_s > 0 ? std::optional(1e3 * (feed_now_s() - since_s)) : std::nullopt;
}

void SourceFeed::attend_survey() {
  Survey* const survey = state_->source.survey.get();
  if (survey == nullptr) return;
  const PlayerState player = state_->source.player->state();
  survey->set_busy(player.playing);
  survey->set_follow(player.follows);
}

/// True for a message, and while a sensor is silent.
bool SourceFeed::attend_sensor() {
  LiveControl* const live = state_->source.player->live();
  if (live == nullptr) return false;
  const LiveStatus status = live->status();
  if (std::exchange(live_tares_, status.tares) < status.tares) load_follower_.forget();
  const bool silent = status.health.since_frame_s > kSilentSeconds && !status.ended;
  if (std::exchange(live_messages_, status.messages) == status.messages || status.messages == 0) {
    return silent;
  }
  state_->window.notice = status.message;
  state_->window.notice.is_failure = status.failed;
  return true;
}

}  // namespace pillarfield::viewer
