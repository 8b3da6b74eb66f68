#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace pillarfield {

/// Threads that share the pieces of a task with the one that has it, and sleep otherwise.
class WorkTeam {
 public:
  /// `members` is at least 1: the calling thread is one of them.
  explicit WorkTeam(std::size_t members);
  ~WorkTeam();
  WorkTeam(const WorkTeam&) = delete;
  WorkTeam& operator=(const WorkTeam&) = delete;

  /// Calls `work(piece)` once for each piece from 0 to `pieces` - 1, in any thread, and waits until
  /// all are done. A single piece is the caller's, and wakes nobody. Work does not throw.
  void run(std::size_t pieces, const std::function<void(std::size_t piece)>& work);

 private:
  void help();
  /// Does pieces while there are any; the lock is held but for the work.
  void take_pieces(std::unique_lock<std::mutex>& lock);

  std::mutex mutex_;
  std::condition_variable wanted_;
  std::condition_variable done_;
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t pieces_ = 0;
  std::size_t busy_ = 0;  ///< pieces that are being worked on
  bool leaving_ = false;
  std::vector<std::thread> helpers_;  ///< last: they use the others
};

}  // namespace pillarfield
