#include "viewer/source/survey.h"

#include <chrono>
#include <exception>
#include <utility>

namespace pillarfield::viewer {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kTellEvery = std::chrono::milliseconds(100);

}  // namespace

Survey::Survey(std::function<std::unique_ptr<FieldProducer>()> open, std::shared_ptr<Curves> curves)
    : open_(std::move(open)), curves_(std::move(curves)), thread_([this] { run(); }) {}

Survey::~Survey() {
  stopping_ = true;
  {
    const std::scoped_lock lock(mutex_);
    changed_.notify_one();
  }
  thread_.join();
}

Survey::Progress Survey::progress() const {
  const std::scoped_lock lock(mutex_);
  return {std::min(curves_->next(), frames_), frames_, failure_};
}

void Survey::on_progress(std::function<void()> wake) {
  const std::scoped_lock lock(waking_);
  wake_ = std::move(wake);
}

void Survey::run() {
  try {
    const std::unique_ptr<FieldProducer> producer = open_();
    if (producer != nullptr) measure_all(*producer);
  } catch (const std::exception& error) {
    const std::scoped_lock lock(mutex_);
    failure_ = error.what();
  }
  tell(true);
}

void Survey::measure_all(FieldProducer& producer) {
  bool rests = false;
  while (!stopping_) {
    const std::uint64_t next = curves_->next();
    set_frames(producer.info().frames);
    if (next >= producer.info().frames) {
      if (!std::exchange(rests, true)) tell(true);
      rest(producer);
      continue;
    }
    rests = false;
    const auto begin = Clock::now();
    if (const auto stored = producer.stored_total(next)) {
      curves_->add(*stored);
    } else {
      curves_->add(producer.produce(next));
    }
    tell(false);
    if (busy_ && !stopping_) std::this_thread::sleep_for(Clock::now() - begin);
  }
}

void Survey::set_frames(std::uint64_t frames) {
  const std::scoped_lock lock(mutex_);
  frames_ = frames;
}

void Survey::rest(FieldProducer& producer) {
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kTellEvery);
  }
  if (!stopping_ && follows_) static_cast<void>(producer.refresh());
}

void Survey::tell(bool at_once) {
  const auto now = Clock::now();
  if (!at_once && now < told_ + kTellEvery) return;
  told_ = now;
  const std::scoped_lock lock(waking_);
  if (wake_) wake_();
}

}  // namespace pillarfield::viewer
