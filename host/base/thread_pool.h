#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace pillarfield {

/// Threads that share the pieces of a task with the calling thread, and sleep otherwise.
class ThreadPool {
 public:
  /// Work on one piece by one member; member 0 is the caller.
  using Work = std::function<void(std::size_t piece, std::size_t member)>;

  /// `members` is at least 1: the calling thread is one of them.
  explicit ThreadPool(std::size_t members);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  /// Calls `work` once for each piece from 0 to `pieces` - 1, in any thread, and waits until all
  /// are done. Wakes at most one member less than there are pieces. Work must not throw.
  void run(std::size_t pieces, const Work& work);

 private:
  void help(std::size_t member);
  /// Works on pieces until none is left; holds the lock except during work.
  void take_pieces(std::unique_lock<std::mutex>& lock, std::size_t member);

  std::mutex mutex_;
  std::condition_variable wanted_;
  std::condition_variable done_;
  const Work* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t pieces_ = 0;
  std::size_t busy_ = 0;  ///< pieces in progress
  bool leaving_ = false;
  std::vector<std::thread> helpers_;  ///< last: they use the other members
};

/// Lowers the priority of the calling thread, so that it waits where processors are scarce: for
/// work beside a solver that must not be late. On Linux a niceness of 5, about a third of the
/// share.
void yield_to_other_threads();

}  // namespace pillarfield
