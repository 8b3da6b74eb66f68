#include "viewer/source/player.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "viewer/source/plane_block.h"
#include "viewer/source/recent_times.h"

namespace pillarfield::viewer {
namespace {

using Time = Playback::Time;

/// Interval between refreshes of a followed source.
constexpr Time kRefreshEvery = std::chrono::milliseconds(100);

Time now() { return std::chrono::steady_clock::now().time_since_epoch(); }

}  // namespace

struct FilePlayer::State {
  explicit State(std::unique_ptr<FieldProducer> from)
      : producer(std::move(from)),
        info(producer->info()),
        playback(info.frames, info.rate_hz),
        thread([this] { run(); }) {}
  ~State() {
    command([this](Time) { stopping = true; });
    thread.join();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Changes the play head and wakes the thread.
  template <class Change>
  void command(Change change) {
    {
      const std::scoped_lock lock(mutex);
      change(now());
    }
    changed.notify_one();
  }

  // Run in the thread. `lock` holds `mutex` on entry and exit.
  void run();
  void produce_until_stopped();
  void wait(std::unique_lock<std::mutex>& lock);
  void refresh(std::unique_lock<std::mutex>& lock);
  void produce(std::uint64_t frame, std::unique_lock<std::mutex>& lock);
  void wake_display();

  const std::unique_ptr<FieldProducer> producer;  ///< used by the thread only, once it runs
  PeakHold peak;                                  ///< likewise
  const SourceInfo info;

  std::mutex mutex;  ///< guards the members up to `failed`
  std::condition_variable changed;
  Playback playback;
  PlayerStatistics counts;
  RecentTimes times;
  Time refreshed{0};
  std::unique_ptr<ShownField> waiting;
  bool wants_contacts = false;
  bool wants_peak = false;
  bool peak_begins = false;
  bool stopping = false;
  std::exception_ptr failed;

  std::mutex waking;  ///< guards `wake`, also while it runs; never held together with `mutex`
  std::function<void()> wake;

  std::thread thread;  ///< last: uses the other members
};

void FilePlayer::State::run() {
  try {
    produce_until_stopped();
    return;
  } catch (...) {
    const std::scoped_lock lock(mutex);
    failed = std::current_exception();
  }
  wake_display();
}

void FilePlayer::State::produce_until_stopped() {
  std::unique_lock lock(mutex);
  while (!stopping) {
    if (playback.follows() && now() >= refreshed + kRefreshEvery) refresh(lock);
    if (stopping) return;
    if (const auto frame = playback.next(now())) {
      produce(*frame, lock);
    } else {
      wait(lock);
    }
  }
}

void FilePlayer::State::wait(std::unique_lock<std::mutex>& lock) {
  std::optional<Time> until = playback.next_due();
  if (!until && playback.follows()) until = refreshed + kRefreshEvery;
  if (until) {
    changed.wait_until(lock, std::chrono::steady_clock::time_point(*until));
  } else {
    changed.wait(lock);
  }
}

void FilePlayer::State::refresh(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  const bool has_grown = producer->refresh();
  lock.lock();
  refreshed = now();
  if (has_grown) playback.set_frames(producer->info().frames, refreshed);
}

void FilePlayer::State::produce(std::uint64_t frame, std::unique_lock<std::mutex>& lock) {
  const bool with_contacts = wants_contacts;
  const bool with_peak = wants_peak;
  const bool begins_peak = std::exchange(peak_begins, false);
  lock.unlock();
  const Time start = now();
  auto field = std::make_unique<ShownField>(producer->produce(frame));
  field->frames = producer->info().frames;
  if (with_contacts) {
    field->contacts = std::make_shared<const ShownContacts>(producer->contacts_of(*field));
  }
  if (with_peak) {
    if (begins_peak) peak.reset();
    peak.add(field->forces);
    field->peak = peak.field(*field);
  }
  const Time end = now();
  lock.lock();
  times.add(start, end);
  ++counts.produced;
  std::swap(waiting, field);
  if (field != nullptr) ++counts.not_shown;
  lock.unlock();
  field.reset();
  wake_display();
  lock.lock();
}

void FilePlayer::State::wake_display() {
  const std::scoped_lock lock(waking);
  if (wake) wake();
}

FilePlayer::FilePlayer(std::unique_ptr<FieldProducer> producer)
    : state_(std::make_unique<State>(std::move(producer))) {}

FilePlayer::~FilePlayer() = default;

const SourceInfo& FilePlayer::info() const { return state_->info; }

void FilePlayer::play() {
  state_->command([this](Time now) { state_->playback.play(now); });
}
void FilePlayer::pause() {
  state_->command([this](Time) { state_->playback.pause(); });
}
void FilePlayer::seek(std::uint64_t frame) {
  state_->command([&](Time now) { state_->playback.seek(frame, now); });
}
void FilePlayer::step(std::int64_t frames) {
  state_->command([&](Time now) { state_->playback.step(frames, now); });
}
void FilePlayer::set_speed(double speed) {
  state_->command([&](Time now) { state_->playback.set_speed(speed, now); });
}
void FilePlayer::set_rate(double rate_hz) {
  state_->command([&](Time now) { state_->playback.set_rate(rate_hz, now); });
}
void FilePlayer::set_loop(bool loop) {
  state_->command([&](Time) { state_->playback.set_loop(loop); });
}
void FilePlayer::set_follow(bool follow) {
  state_->command([&](Time now) { state_->playback.set_follow(follow, now); });
}
void FilePlayer::set_contacts(bool wanted) {
  state_->command([&](Time now) {
    if (wanted == state_->wants_contacts) return;
    state_->wants_contacts = wanted;
    if (wanted) state_->playback.again(now);
  });
}

void FilePlayer::set_peak(bool wanted) {
  state_->command([&](Time now) {
    state_->wants_peak = wanted;
    state_->peak_begins = wanted;
    if (wanted) state_->playback.again(now);
  });
}

PlayerState FilePlayer::state() const {
  const std::scoped_lock lock(state_->mutex);
  const Playback& playback = state_->playback;
  return {.frame = playback.frame(),
          .frames = playback.frames(),
          .playing = playback.playing(),
          .loops = playback.loops(),
          .follows = playback.follows(),
          .speed = playback.speed(),
          .rate_hz = playback.rate_hz()};
}

PlayerStatistics FilePlayer::statistics() const {
  const std::scoped_lock lock(state_->mutex);
  const Time time = now();
  state_->times.forget_before(time);
  PlayerStatistics statistics = state_->counts;
  statistics.waiting = state_->waiting != nullptr ? 1 : 0;
  statistics.produced_hz = state_->times.rate_hz();
  statistics.produce_ms_median = state_->times.median_ms();
  statistics.produce_ms_worst = state_->times.worst_ms();
  statistics.behind_ms =
      std::chrono::duration<double, std::milli>(state_->playback.behind(time)).count();
  return statistics;
}

std::optional<ShownField> FilePlayer::take() {
  const std::scoped_lock lock(state_->mutex);
  if (state_->waiting != nullptr) {
    ++state_->counts.taken;
    return std::move(*std::exchange(state_->waiting, nullptr));
  }
  if (state_->failed) std::rethrow_exception(std::exchange(state_->failed, nullptr));
  return std::nullopt;
}

void FilePlayer::on_new_field(std::function<void()> wake) {
  const std::scoped_lock lock(state_->waking);
  state_->wake = std::move(wake);
}

}  // namespace pillarfield::viewer
