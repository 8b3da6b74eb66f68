#include "simulation/render_ahead.h"

#include <algorithm>
#include <system_error>

namespace pillarfield {

RenderAhead::RenderAhead(const Simulator& simulator, std::uint64_t first, std::uint64_t count,
                         unsigned threads, bool in_order)
    : simulator_(simulator), first_(first), count_(count), in_order_(in_order) {
  const Skin& skin = simulator.scene().skin;
  for (std::uint64_t i = 0; i < std::min<std::uint64_t>(count, std::uint64_t{threads} + 2); ++i) {
    ring_.push_back({.raw = FrameBuffer(simulator.sensel_type(), skin.rows, skin.cols),
                     .truth = ForceField(skin)});
  }
  try {
    for (unsigned i = 1; i < threads && i < count; ++i) helpers_.emplace_back([this] { help(); });
  } catch (const std::system_error&) {
    // The limit of threads is reached; the caller renders.
  }
}

RenderAhead::~RenderAhead() {
  {
    const std::scoped_lock lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
}

bool RenderAhead::may_claim() const {
  return claimed_ < count_ && claimed_ < taken_ + ring_.size() && !(in_order_ && busy_ > 0);
}

void RenderAhead::render_next(Lock& lock) {
  const std::uint64_t number = claimed_++;
  Frame& frame = place_of(number);
  ++busy_;
  lock.unlock();
  try {
    simulator_.render(first_ + number, frame.raw, frame.truth);
  } catch (...) {
    frame.failed = std::current_exception();
  }
  lock.lock();
  --busy_;
  frame.rendered = true;
  changed_.notify_all();
}

void RenderAhead::help() {
  Lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopped_ || claimed_ == count_ || may_claim(); });
    if (stopped_ || claimed_ == count_) return;
    render_next(lock);
  }
}

void RenderAhead::deliver(const Simulator::TakeFrame& take) {
  Lock lock(mutex_);
  for (std::uint64_t number = 0; number < count_; ++number) {
    Frame& frame = place_of(number);
    while (!frame.rendered) {
      if (may_claim()) {
        render_next(lock);
      } else {
        changed_.wait(lock);
      }
    }
    lock.unlock();
    if (frame.failed) std::rethrow_exception(frame.failed);
    take(first_ + number, frame.raw.view(), frame.truth);
    lock.lock();
    frame.rendered = false;
    ++taken_;
    changed_.notify_all();
  }
}

}  // namespace pillarfield
