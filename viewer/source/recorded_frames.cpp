#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <thread>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/growing_file.h"
#include "viewer/source/object_pool.h"
#include "viewer/source/solved_producer.h"

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
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> done = 0;
  const auto render_frames = [&] {
    const Skin& skin = simulator.scene().skin;
    ForceField truth(skin.element_rows(), skin.element_cols());
    for (std::size_t index = next++; index < made.size(); index = next++, ++done) {
      auto readings = std::make_shared<FrameBuffer>(simulator.sensel_type(), skin.rows, skin.cols);
      simulator.render(index, *readings, truth);
      made[index] = {std::move(readings), simulator.time_of(index)};
    }
  };
  std::vector<std::future<void>> threads;
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  try {
    for (std::size_t i = 0; i < std::min<std::size_t>(cores, frames); ++i) {
      threads.push_back(std::async(std::launch::async, render_frames));
    }
    for (std::future<void>& thread : threads) {
      while (thread.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(frames));
      }
      thread.get();
    }
    if (progress) progress(1);
  } catch (...) {
    next = made.size();  // The other threads end after their frames.
    for (const std::future<void>& thread : threads) {
      if (thread.valid()) thread.wait();
    }
    throw;
  }
  return std::make_unique<SimulatedFrames>(std::move(made));
}

}  // namespace pillarfield::viewer
