#include "cli/stream/replay.h"

#include <fmt/format.h>

#include "cli/pace/frames.h"
#include "cli/warnings.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"
#include "pillarfield/scene.h"

namespace pillarfield::cli {
namespace {

constexpr std::uint64_t kMostSceneBytes = std::uint64_t{1} << 30U;

/// Counts laps of a replay; a lap lasts one frame interval longer than its last frame's time.
class Laps {
 public:
  Laps(std::uint64_t frames, bool repeat) : frames_(frames), repeat_(repeat) {}

  [[nodiscard]] bool is_over() const { return index_ == frames_ && !repeat_; }
  /// The index of the next frame.
  std::uint64_t take() {
    if (index_ == frames_) index_ = 0;
    ++sequence_;
    return index_++;
  }
  [[nodiscard]] std::uint64_t sequence() const { return sequence_; }  ///< frames taken
  [[nodiscard]] std::uint64_t finished() const { return (sequence_ - 1) / frames_; }

 private:
  std::uint64_t frames_;
  bool repeat_;
  std::uint64_t index_ = 0;
  std::uint64_t sequence_ = 0;
};

class ReplayedScene final : public FrameStream {
 public:
  ReplayedScene(PaceFrames frames, double interval_s, bool repeat)
      : frames_(std::move(frames)), interval_s_(interval_s), laps_(frames_.loaded.size(), repeat) {}

  [[nodiscard]] const Skin& skin() const override { return frames_.skin; }
  [[nodiscard]] SenselType sensel_type() const override { return frames_.sensel_type; }
  [[nodiscard]] const Calibration& calibration() const override { return frames_.calibration; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds) override {
    frame.sequence = laps_.sequence();
    if (laps_.is_over()) return Arrival::ended;
    frame.readings = frames_.loaded[laps_.take()].view();
    frame.missing.clear();
    frame.time_s = interval_s_ * static_cast<double>(frame.sequence);
    return Arrival::arrived;
  }

 private:
  PaceFrames frames_;
  double interval_s_;
  Laps laps_;
};

class ReplayedFile final : public FrameStream {
 public:
  ReplayedFile(const std::string& file, std::unique_ptr<FrameSource> source, bool repeat)
      : source_(std::move(source)), laps_(source_->frames(), repeat) {
    const std::uint64_t frames = source_->frames();
    if (frames < 2) return;
    const double length = source_->time(frames - 1) - source_->time(0);
    if (!(length > 0)) {
      throw Error(file, "the times of its frames do not rise", "give --rate");
    }
    lap_s_ = length * static_cast<double>(frames) / static_cast<double>(frames - 1);
  }

  [[nodiscard]] const Skin& skin() const override { return source_->skin(); }
  [[nodiscard]] SenselType sensel_type() const override { return source_->sensel_type(); }
  [[nodiscard]] const Calibration& calibration() const override { return source_->calibration(); }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds) override {
    frame.sequence = laps_.sequence();
    if (laps_.is_over()) return Arrival::ended;
    frame.time_s =
        source_->read(laps_.take(), frame.buffer) + lap_s_ * static_cast<double>(laps_.finished());
    frame.readings = frame.buffer.view();
    frame.missing.clear();
    return Arrival::arrived;
  }

 private:
  std::unique_ptr<FrameSource> source_;
  double lap_s_ = 0.01;
  Laps laps_;
};

std::unique_ptr<FrameStream> replayed_scene(const std::string& file, bool repeat, bool quiet) {
  const Scene scene = load_scene_with_warnings(file);
  PaceFrames frames = open_pace_frames(file, {});
  load(frames, frames.in_source, kMostSceneBytes, quiet);
  return std::make_unique<ReplayedScene>(std::move(frames), 1 / scene.rate_hz, repeat);
}

}  // namespace

std::unique_ptr<FrameStream> replayed_file(const std::string& file, const ReadOptions& options,
                                           std::optional<double> rate_hz, bool repeat, bool quiet) {
  std::unique_ptr<FrameStream> stream;
  if (is_scene(file)) {
    stream = replayed_scene(file, repeat, quiet);
  } else {
    ReadOptions read = options;
    read.rate_hz = rate_hz;
    read.untimed = rate_hz.has_value();
    auto source = open_frames_with_warnings(file, read, quiet);
    if (source->frames() == 0) {
      throw Error(file, "it has no frames", "give a recording with at least one");
    }
    stream = std::make_unique<ReplayedFile>(file, std::move(source), repeat);
  }
  return paced_stream(std::move(stream), {.rate_hz = rate_hz});
}

}  // namespace pillarfield::cli
