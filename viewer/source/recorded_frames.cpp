#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/frame_provider.h"
#include "viewer/source/growing_file.h"
#include "viewer/source/object_pool.h"

namespace pillarfield::viewer {
namespace {

class RecordedFrames final : public FrameProvider {
 public:
  RecordedFrames(const std::filesystem::path& path, std::unique_ptr<FrameSource> source,
                 ReadOptions options)
      : file_(path),
        options_(std::move(options)),
        source_(std::move(source)),
        skin_(source_->skin()),
        sensel_type_(source_->sensel_type()),
        frames_(source_->frames()),
        buffers_(FieldProducer::kMostShown, [this] {
          return std::make_unique<FrameBuffer>(sensel_type_, skin_.rows, skin_.cols);
        }) {
    options_.tare_frames = 0;  // The tare stays that of the first opening.
  }

  [[nodiscard]] std::uint64_t frames() const override { return frames_; }

  [[nodiscard]] FrameHandle frame(std::uint64_t index) override {
    if (source_ == nullptr) open(file_.path());
    const std::shared_ptr<FrameBuffer> buffer = buffers_.acquire();
    if (buffer == nullptr) throw_all_fields_in_use();
    const double time_s = source_->read(index, *buffer);
    return {buffer, time_s};
  }

  bool refresh() override {
    if (!file_.may_have_changed()) return false;
    source_.reset();  // HDF5 does not show new data in a file that it holds open.
    if (!file_.reopen([this](const std::filesystem::path& path) { open(path); })) return false;
    const std::uint64_t before = std::exchange(frames_, source_->frames());
    return frames_ != before;
  }

 private:
  void open(const std::filesystem::path& path) {
    std::unique_ptr<FrameSource> source = open_frames(path, options_);
    const Skin& skin = source->skin();
    if (skin.rows != skin_.rows || skin.cols != skin_.cols || skin.layout != skin_.layout ||
        source->sensel_type() != sensel_type_ || source->frames() == 0) {
      throw Error(path.string(), "it was replaced by another recording", "open it again");
    }
    source_ = std::move(source);
  }

  GrowingFile file_;
  ReadOptions options_;
  std::unique_ptr<FrameSource> source_;  ///< null where reopening failed
  Skin skin_;
  SenselType sensel_type_;
  std::uint64_t frames_;
  ObjectPool<FrameBuffer> buffers_;
};

}  // namespace

std::unique_ptr<FrameProvider> recorded_frames(const std::filesystem::path& path,
                                               std::unique_ptr<FrameSource> source,
                                               ReadOptions options) {
  return std::make_unique<RecordedFrames>(path, std::move(source), std::move(options));
}

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
    do {
      ended_.wait_for(lock, std::chrono::milliseconds(50), [this] { return working_ == 0; });
      if (!progress) continue;
      const double share = static_cast<double>(done_) / static_cast<double>(frames_.size());
      lock.unlock();
      progress(share);
      lock.lock();
    } while (working_ > 0);
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
    ForceField truth(skin.element_rows(), skin.element_cols());
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
