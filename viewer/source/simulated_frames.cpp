#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "viewer/source/frame_provider.h"

namespace pillarfield::viewer {
namespace {

using Frames = std::vector<FrameHandle>;

/// Threads that each render the next unclaimed frame.
class Rendering {
 public:
  Rendering(const Simulator& simulator, Frames& frames) : simulator_(simulator), frames_(frames) {
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t threads = std::min(cores, frames.size());
    working_ = threads;
    for (std::size_t i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  }
  ~Rendering() { stop_ = true; }
  Rendering(const Rendering&) = delete;
  Rendering& operator=(const Rendering&) = delete;

  /// Waits for all threads; rethrows the exception of one.
  void wait(const std::function<void(double)>& progress) {
    std::unique_lock lock(mutex_);
    while (working_ > 0) {
      ended_.wait_for(lock, std::chrono::milliseconds(50));
      if (!progress) continue;
      const double share = static_cast<double>(done_) / static_cast<double>(frames_.size());
      lock.unlock();
      progress(share);
      lock.lock();
    }
    if (failed_) std::rethrow_exception(failed_);
  }

 private:
  void work() {
    try {
      render_frames();
    } catch (...) {
      stop_ = true;
      const std::scoped_lock lock(mutex_);
      failed_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    --working_;
    ended_.notify_one();
  }

  void render_frames() {
    const Skin& skin = simulator_.scene().skin;
    ForceField truth(skin.pillar_rows(), skin.pillar_cols());
    for (std::size_t index = next_++; index < frames_.size() && !stop_; index = next_++) {
      const auto readings =
          std::make_shared<FrameBuffer>(simulator_.sensel_type(), skin.rows, skin.cols);
      simulator_.render(index, *readings, truth);
      frames_[index] = {readings, simulator_.time_of(index)};
      ++done_;
    }
  }

  const Simulator& simulator_;
  Frames& frames_;
  std::atomic<std::size_t> next_ = 0;
  std::atomic<std::size_t> done_ = 0;
  std::atomic<bool> stop_ = false;
  std::mutex mutex_;  ///< guards the next two members
  std::size_t working_ = 0;
  std::exception_ptr failed_;
  std::condition_variable ended_;
  std::vector<std::jthread> threads_;  ///< last: use the other members
};

class SimulatedFrames final : public FrameProvider {
 public:
  explicit SimulatedFrames(Frames frames) : frames_(std::move(frames)) {}
  [[nodiscard]] std::uint64_t frames() const override { return frames_.size(); }
  [[nodiscard]] FrameHandle frame(std::uint64_t index) override { return frames_.at(index); }

 private:
  Frames frames_;
};

}  // namespace

std::unique_ptr<FrameProvider> simulate_frames(const Simulator& simulator, std::uint64_t frames,
                                               const std::function<void(double)>& progress) {
  Frames made(frames);
  Rendering(simulator, made).wait(progress);
  return std::make_unique<SimulatedFrames>(std::move(made));
}

}  // namespace pillarfield::viewer
