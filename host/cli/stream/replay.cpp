#include "cli/stream/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "cli/interrupt.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/error.h"
#include "pillarfield/recording.h"
#include "pillarfield/simulator.h"

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

/// The first frames of a scene, as many as fit into memory.
class ReplayedScene final : public FrameStream {
 public:
  ReplayedScene(const Simulator& simulator, bool repeat, bool quiet)
      : skin_(simulator.scene().skin),
        sensel_type_(simulator.sensel_type()),
        calibration_(simulator.calibration()),
        interval_s_(1 / simulator.scene().rate_hz),
        laps_(frames_of(simulator), repeat) {
    const std::uint64_t frames = frames_of(simulator);
    ForceField truth(skin_.element_rows(), skin_.element_cols());
    Progress progress("Simulating", frames, quiet);
    for (std::uint64_t index = 0; index < frames && !is_interrupted(); ++index) {
      frames_.emplace_back(sensel_type_, skin_.rows, skin_.cols);
      simulator.render(index, frames_.back(), truth);
      progress.show(index + 1);
    }
  }

  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return sensel_type_; }
  [[nodiscard]] const Calibration& calibration() const override { return calibration_; }
  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds) override {
    frame.sequence = laps_.sequence();
    if (laps_.is_over()) return Arrival::ended;
    frame.readings = frames_[laps_.take()].view();
    frame.missing.clear();
    frame.time_s = interval_s_ * static_cast<double>(frame.sequence);
    return Arrival::arrived;
  }

 private:
  static std::uint64_t frames_of(const Simulator& simulator) {
    const std::uint64_t bytes = simulator.scene().skin.sensels() * size_of(simulator.sensel_type());
    return std::min<std::uint64_t>(simulator.scene().frames,
                                   std::max<std::uint64_t>(kMostSceneBytes / bytes, 1));
  }

  Skin skin_;
  SenselType sensel_type_;
  Calibration calibration_;
  double interval_s_;
  Laps laps_;
  std::vector<FrameBuffer> frames_;
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

}  // namespace

bool is_scene(const std::string& file) { return file.ends_with(".toml"); }

std::unique_ptr<FrameStream> replayed_file(const std::string& file, const ReadOptions& options,
                                           std::optional<double> rate_hz, bool repeat,
                                           bool drops_late, bool quiet) {
  constexpr double kMostPeriodsLate = 4;
  std::unique_ptr<FrameStream> stream;
  if (is_scene(file)) {
    const Simulator simulator(load_scene_with_warnings(file));
    stream = std::make_unique<ReplayedScene>(simulator, repeat, quiet);
    if (is_interrupted()) return nullptr;
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
  Pace pace = {.rate_hz = rate_hz};
  if (drops_late) {
    pace.drop_after =
        std::chrono::nanoseconds(static_cast<std::int64_t>(1e9 * kMostPeriodsLate / *rate_hz));
  }
  return paced_stream(std::move(stream), pace);
}

}  // namespace pillarfield::cli
