#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace pillarfield {

/// Threads that share the pieces of a task with the one that has it, and sleep otherwise.
class ThreadPool {
 public:
  /// What is to be done of a piece, by which member: the caller is 0.
  using Work = std::function<void(std::size_t piece, std::size_t member)>;

  /// `members` is at least 1: the calling thread is one of them.
  explicit ThreadPool(std::size_t members);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls `work` once for each piece from 0 to `pieces` - 1, in any thread, and waits until all
  /// are done. A single piece is the caller's, and wakes nobody; of several, no more members are
  /// woken than there are pieces. Work does not throw.
  void run(std::size_t pieces, const Work& work);

 private:
  void help(std::size_t member);
  /// Does pieces while there are any; the lock is held but for the work.
  void take_pieces(std::unique_lock<std::mutex>& lock, std::size_t member);

  std::mutex mutex_;
  std::condition_variable wanted_;
  std::condition_variable done_;
  const Work* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t pieces_ = 0;
  std::size_t busy_ = 0;  ///< pieces that are being worked on
  bool leaving_ = false;
  std::vector<std::thread> helpers_;  ///< last: they use the others
};

}  // namespace pillarfield
