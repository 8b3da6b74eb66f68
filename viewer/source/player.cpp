#include "viewer/source/player.h"

#include <condition_variable>
#include <thread>
#include <utility>

namespace pillarfield::viewer {
namespace {

using Time = Playback::Time;

/// Interval between refreshes of a followed source.
constexpr Time kRefreshEvery = std::chrono::milliseconds(100);

Time now() { return std::chrono::steady_clock::now().time_since_epoch(); }

}  // namespace

void NewestField::count() {
  const std::scoped_lock lock(mutex_);
  ++produced_;
  times_.add(now());
}

void NewestField::set(ShownField field) {
  {
    std::optional<ShownField> next(std::move(field));
    const std::scoped_lock lock(mutex_);
    std::swap(waiting_, next);
  }
  wake_display();
}

void NewestField::end(std::exception_ptr failure) {
  {
    const std::scoped_lock lock(mutex_);
    failed_ = std::move(failure);
  }
  wake_display();
}

void NewestField::wake_display() {
  const std::scoped_lock lock(waking_);
  if (wake_) wake_();
}

std::optional<ShownField> NewestField::take() {
  const std::scoped_lock lock(mutex_);
  if (waiting_) {
    ++taken_;
    return std::exchange(waiting_, std::nullopt);
  }
  if (failed_) std::rethrow_exception(std::exchange(failed_, nullptr));
  return std::nullopt;
}

PlayerStatistics NewestField::statistics() const {
  const std::scoped_lock lock(mutex_);
  times_.forget_before(now());
  const std::uint64_t waiting = waiting_ ? 1 : 0;
  return {.produced = produced_,
          .taken = taken_,
          .not_shown = produced_ - taken_ - waiting,
          .waiting = waiting,
          .produced_hz = times_.rate_hz()};
}

void NewestField::on_new_field(std::function<void()> wake) {
  const std::scoped_lock lock(waking_);
  wake_ = std::move(wake);
}

namespace {

class FilePlayer final : public Player {
 public:
  explicit FilePlayer(std::unique_ptr<FieldProducer> producer)
      : producer_(std::move(producer)),
        info_(producer_->info()),
        head_(info_.frames, info_.rate_hz),
        thread_([this] { run(); }) {}
  ~FilePlayer() override {
    change([this](Playback&, Time) { stopping_ = true; });
    thread_.join();
  }

  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] PlayerState state() const override {
    const std::scoped_lock lock(mutex_);
    return {.frame = head_.frame(),
            .frames = head_.frames(),
            .playing = head_.playing(),
            .loops = head_.loops(),
            .follows = head_.follows(),
            .speed = head_.speed(),
            .rate_hz = head_.rate_hz()};
  }
  void set_contacts(bool wanted) override {
    change([=, this](Playback& head, Time now) {
      if (!std::exchange(wants_contacts_, wanted) && wanted) head.again(now);
    });
  }

 private:
  void move(const Move& wanted) override { change(wanted); }

  /// Changes the play head and wakes the thread.
  template <class Change>
  void change(const Change& wanted) {
    {
      const std::scoped_lock lock(mutex_);
      wanted(head_, now());
    }
    changed_.notify_one();
  }

  // Run in the thread. `lock` holds `mutex_` on entry and exit.
  void run();
  void produce_until_stopped();
  void wait(std::unique_lock<std::mutex>& lock);
  void refresh(std::unique_lock<std::mutex>& lock);
  void produce(std::uint64_t frame, std::unique_lock<std::mutex>& lock);

  const std::unique_ptr<FieldProducer> producer_;  ///< used by the thread only, once it runs
  const SourceInfo info_;

  mutable std::mutex mutex_;  ///< guards the members up to `stopping_`
  std::condition_variable changed_;
  Playback head_;
  Time refreshed_{0};
  bool wants_contacts_ = false;
  bool stopping_ = false;

  std::thread thread_;  ///< last: uses the other members
};

void FilePlayer::run() {
  try {
    produce_until_stopped();
  } catch (...) {
    newest_.end(std::current_exception());
  }
}

void FilePlayer::produce_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    if (head_.follows() && now() >= refreshed_ + kRefreshEvery) refresh(lock);
    if (stopping_) return;
    if (const auto frame = head_.next(now())) {
      produce(*frame, lock);
    } else {
      wait(lock);
    }
  }
}

void FilePlayer::wait(std::unique_lock<std::mutex>& lock) {
  std::optional<Time> until = head_.next_due();
  if (!until && head_.follows()) until = refreshed_ + kRefreshEvery;
  if (until) {
    changed_.wait_until(lock, std::chrono::steady_clock::time_point(*until));
  } else {
    changed_.wait(lock);
  }
}

void FilePlayer::refresh(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  const bool has_grown = producer_->refresh();
  lock.lock();
  refreshed_ = now();
  if (has_grown) head_.set_frames(producer_->info().frames, refreshed_);
}

void FilePlayer::produce(std::uint64_t frame, std::unique_lock<std::mutex>& lock) {
  const bool with_contacts = wants_contacts_;
  lock.unlock();
  ShownField field = producer_->produce(frame);
  field.frames = producer_->info().frames;
  if (with_contacts) {
    field.contacts = std::make_shared<const ShownContacts>(producer_->contacts_of(field));
  }
  newest_.count();
  newest_.set(std::move(field));
  lock.lock();
}

}  // namespace

std::unique_ptr<Player> play_file(std::unique_ptr<FieldProducer> producer) {
  return std::make_unique<FilePlayer>(std::move(producer));
}

}  // namespace pillarfield::viewer
