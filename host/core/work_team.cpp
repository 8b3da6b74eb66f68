#include "core/work_team.h"

namespace pillarfield {

WorkTeam::WorkTeam(std::size_t members) {
  for (std::size_t i = 1; i < members; ++i) helpers_.emplace_back([this] { help(); });
}

WorkTeam::~WorkTeam() {
  {
    const std::scoped_lock lock(mutex_);
    leaving_ = true;
  }
  wanted_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void WorkTeam::run(std::size_t pieces, const std::function<void(std::size_t)>& work) {
  std::unique_lock lock(mutex_);
  work_ = &work;
  next_ = 0;
  pieces_ = pieces;
  if (pieces > 1) wanted_.notify_all();
  take_pieces(lock);
  done_.wait(lock, [this] { return busy_ == 0; });
}

void WorkTeam::take_pieces(std::unique_lock<std::mutex>& lock) {
  while (next_ < pieces_) {
    const std::size_t piece = next_++;
    ++busy_;
    lock.unlock();
    (*work_)(piece);
    lock.lock();
    --busy_;
  }
}

void WorkTeam::help() {
  std::unique_lock lock(mutex_);
  while (true) {
    wanted_.wait(lock, [this] { return leaving_ || next_ < pieces_; });
    if (leaving_) return;
    take_pieces(lock);
    if (busy_ == 0) done_.notify_one();
  }
}

}  // namespace pillarfield
