#include "base/thread_pool.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace pillarfield {

ThreadPool::ThreadPool(std::size_t members) {
  for (std::size_t i = 1; i < members; ++i) helpers_.emplace_back([this, i] { help(i); });
}

ThreadPool::~ThreadPool() {
  {
    const std::scoped_lock lock(mutex_);
    leaving_ = true;
  }
  wanted_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void ThreadPool::run(std::size_t pieces, const Work& work) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  next_ = 0;
  pieces_ = pieces;
  const std::size_t woken = std::min(helpers_.size(), pieces - std::min<std::size_t>(pieces, 1));
  for (std::size_t i = 0; i < woken; ++i) wanted_.notify_one();
  take_pieces(lock, 0);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void ThreadPool::take_pieces(std::unique_lock<std::mutex>& lock, std::size_t member) {
  while (next_ < pieces_) {
    const std::size_t piece = next_++;
    ++busy_;
    lock.unlock();
    (*work_)(piece, member);
    lock.lock();
    --busy_;
  }
}

void ThreadPool::help(std::size_t member) {
  std::unique_lock lock(mutex_);
  while (true) {
    wanted_.wait(lock, [this] { return leaving_ || next_ < pieces_; });
    if (leaving_) return;
    take_pieces(lock, member);
    if (busy_ == 0) done_.notify_one();
  }
}

void yield_to_other_threads() {
  constexpr int kNiceness = 5;
  // Linux keeps a niceness for each thread. Only a raise may be refused.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);
}

}  // namespace pillarfield
