#include "streams/sink/queued_sink.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "base/thread_pool.h"

namespace pillarfield {

QueuedSink::QueuedSink(std::string name, std::unique_ptr<SinkConsumer> consumer,
                       const QueueLimits& limits)
    : name_(std::move(name)),
      limits_(limits),
      consumer_(std::move(consumer)),
      slots_(std::max<std::size_t>(limits.frames, 1)) {
  free_.reserve(slots_.size());
  for (Slot& slot : slots_) free_.push_back(&slot);
  thread_ = std::thread([this] {
    yield_to_other_threads();
    run();
  });
}

QueuedSink::~QueuedSink() { end_thread(End::abandoned); }

void QueuedSink::append(const SolvedFrame& frame) {
  const FrameParts parts = consumer_->wants(frame);
  if (!parts.any()) return;
  const std::size_t bytes = bytes_of(frame, parts);
  Slot* const slot = take_slot(bytes);
  if (slot == nullptr) return;
  slot->bytes = bytes;
  try {
    slot->copy.assign(frame, parts);
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(slot);
    waiting_bytes_ += bytes;
  } catch (const std::exception&) {  // no memory
    const std::scoped_lock lock(mutex_);
    ++dropped_;
    free_slot(*slot);
    return;
  }
  changed_.notify_one();
}

/// Returns null, and counts the frame as dropped, if it may not wait.
QueuedSink::Slot* QueuedSink::take_slot(std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  const bool is_full =
      free_.empty() || (!waiting_.empty() && waiting_bytes_ + bytes > limits_.bytes);
  if (is_full || end_ != End::none || !failure_.empty()) {
    ++dropped_;
    return nullptr;
  }
  Slot* const slot = free_.back();
  free_.pop_back();
  free_bytes_ -= slot->capacity;
  return slot;
}

/// Takes a slot back, with its memory if that is within the limits. The mutex is locked.
void QueuedSink::free_slot(Slot& slot) {
  slot.capacity = slot.copy.capacity();
  if (waiting_bytes_ + free_bytes_ + slot.capacity > limits_.bytes) {
    slot.copy.release();
    slot.capacity = 0;
  }
  free_bytes_ += slot.capacity;
  free_.push_back(&slot);
}

void QueuedSink::report(const HealthReport& health) {
  {
    const std::scoped_lock lock(mutex_);
    health_ = health;
  }
  changed_.notify_one();
}

void QueuedSink::set_tare(const LiveSinkInfo& info) {
  {
    const std::scoped_lock lock(mutex_);
    tare_ = info;
  }
  changed_.notify_one();
}

void QueuedSink::finish() { end_thread(End::finished); }

void QueuedSink::end_thread(End end) {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    end_ = end;
  }
  changed_.notify_one();
  thread_.join();
}

LiveSinkStatistics QueuedSink::statistics() const {
  LiveSinkStatistics statistics;
  {
    const std::scoped_lock lock(mutex_);
    statistics.frames = frames_;
    statistics.dropped = dropped_;
    statistics.failure = failure_;
  }
  consumer_->add_to(statistics);
  return statistics;
}

void QueuedSink::run() {
  try {
    work();
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

/// Stops the sink; frames that wait are dropped.
void QueuedSink::fail(const std::string& reason) {
  const std::scoped_lock lock(mutex_);
  if (failure_.empty()) failure_ = reason;
  dropped_ += waiting_.size();
  waiting_.clear();
  waiting_bytes_ = 0;
}

void QueuedSink::work() {
  constexpr std::chrono::milliseconds kIdle{100};
  std::unique_lock lock(mutex_);
  while (failure_.empty()) {
    const bool has_work = changed_.wait_for(
        lock, kIdle, [&] { return !waiting_.empty() || health_ || tare_ || end_ != End::none; });
    if (tare_) {
      const LiveSinkInfo tare = *std::exchange(tare_, std::nullopt);
      lock.unlock();
      consumer_->set_tare(tare);
      lock.lock();
      continue;
    }
    if (health_) {
      const HealthReport health = *std::exchange(health_, std::nullopt);
      lock.unlock();
      consumer_->report(health);
      lock.lock();
    } else if (!waiting_.empty()) {
      consume_oldest(lock);
    } else if (has_work) {
      break;
    } else {
      lock.unlock();
      consumer_->idle();
      lock.lock();
    }
  }
  const bool finishes = end_ == End::finished && failure_.empty();
  lock.unlock();
  if (finishes) consumer_->finish();
}

void QueuedSink::consume_oldest(std::unique_lock<std::mutex>& lock) {
  Slot& slot = *waiting_.front();
  lock.unlock();
  const bool arrived = consumer_->consume(slot.copy.frame());
  lock.lock();
  ++(arrived ? frames_ : dropped_);
  waiting_.pop_front();
  waiting_bytes_ -= slot.bytes;
  free_slot(slot);
}

}  // namespace pillarfield
