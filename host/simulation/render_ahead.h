#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "pillarfield/simulator.h"

namespace pillarfield {

/// Threads that render the next frames into a ring of buffers while the caller takes the earlier
/// ones; the caller renders too where its frame is not claimed yet.
class RenderAhead {
 public:
  /// Frames `first` to `first` + `count` - 1; `in_order`: one frame at a time, for scenes whose
  /// frames depend on the one before. `threads` is at least 1.
  RenderAhead(const Simulator& simulator, std::uint64_t first, std::uint64_t count,
              unsigned threads, bool in_order);
  ~RenderAhead();
  RenderAhead(const RenderAhead&) = delete;
  RenderAhead& operator=(const RenderAhead&) = delete;

  /// Calls `take` for each frame; once.
  void deliver(const Simulator::TakeFrame& take);

 private:
  struct Frame {
    FrameBuffer raw;
    ForceField truth;
    bool rendered = false;
    std::exception_ptr failed = nullptr;
  };
  using Lock = std::unique_lock<std::mutex>;

  void help();
  [[nodiscard]] bool may_claim() const;
  /// Renders the next frame; releases the lock meanwhile.
  void render_next(Lock& lock);
  [[nodiscard]] Frame& place_of(std::uint64_t number) { return ring_[number % ring_.size()]; }

  const Simulator& simulator_;
  const std::uint64_t first_;
  const std::uint64_t count_;
  const bool in_order_;
  std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  std::vector<Frame> ring_;
  std::uint64_t claimed_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t busy_ = 0;  ///< frames being rendered
  bool stopped_ = false;
  std::vector<std::jthread> helpers_;  ///< last: they use the other members
};

}  // namespace pillarfield
