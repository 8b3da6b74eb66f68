#pragma once

#include <barrier>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace pillarfield::bench {

/// Threads that work together and sleep otherwise: those of OpenMP spin on for a while when their
/// work is done, at the cost of whoever is timed next.
class ThreadTeam {
 public:
  /// The calling thread is one of `members`.
  explicit ThreadTeam(int members);
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  [[nodiscard]] int members() const { return static_cast<int>(threads_.size()) + 1; }

  /// Calls `work(member)` once for each member, 0 being the caller, and waits for all.
  void run(const std::function<void(int member)>& work);

  /// Within the work: waits until every member is here.
  void meet() { meeting_.arrive_and_wait(); }

 private:
  void serve(int member);

  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void(int)>* work_ = nullptr;
  unsigned started_ = 0;  ///< runs
  int busy_ = 0;          ///< threads
  bool leaving_ = false;
  std::barrier<> meeting_;
  std::vector<std::thread> threads_;
};

}  // namespace pillarfield::bench
