#include <chrono>
#include <limits>
#include <utility>

#include "io/file_kind.h"
#include "pillarfield/recording.h"
#include "streams/live_sink.h"
#include "streams/sink/queued_sink.h"

namespace pillarfield {
namespace {

/// Writes a file of forces.
class FileConsumer final : public SinkConsumer {
 public:
  FileConsumer(std::unique_ptr<ForceSink> file, const ForceFileInfo& info)
      : file_(std::move(file)),
        parts_{.forces = true,
               .all_planes = info.angles || info.uncertainty,
               .contacts = info.contacts.has_value()} {}

  [[nodiscard]] FrameParts wants(const SolvedFrame&) override { return parts_; }
  [[nodiscard]] bool consume(const SolvedFrame& frame) override {
    file_->append(frame);
    return true;
  }
  void finish() override { file_->finish(); }

 private:
  std::unique_ptr<ForceSink> file_;
  FrameParts parts_;
};

/// A live tare may bring the noise, for which the file needs a plane from the start.
Calibration with_room_for_noise(Calibration calibration) {
  if (calibration.noise.empty()) calibration.noise.assign(calibration.tare.size(), 0);
  return calibration;
}

/// Records the raw frames, and flushes them once a second.
class RecordingConsumer final : public SinkConsumer {
 public:
  RecordingConsumer(const std::string& path, const LiveSinkInfo& info)
      : writer_(path, info.skin, info.sensel_type, with_room_for_noise(info.calibration),
                {.flush_every = std::numeric_limits<std::uint32_t>::max(),
                 .replace = info.replace,
                 .missing = true}) {}

  [[nodiscard]] FrameParts wants(const SolvedFrame&) override { return {.readings = true}; }
  [[nodiscard]] bool consume(const SolvedFrame& frame) override {
    if (frame.missing.empty()) {
      writer_.append(frame.readings, frame.time_s);
    } else {
      writer_.append_incomplete(frame.readings, frame.time_s, frame.missing);
    }
    has_unflushed_ = true;
    idle();
    return true;
  }
  void idle() override {
    constexpr std::chrono::seconds kInterval{1};
    const auto now = std::chrono::steady_clock::now();
    if (!has_unflushed_ || now - flushed_ < kInterval) return;
    writer_.flush();
    flushed_ = now;
    has_unflushed_ = false;
  }
  void set_tare(const LiveSinkInfo& info) override {
    writer_.set_tare(info.calibration, info.skin.threshold_counts);
  }
  void finish() override { writer_.finish(); }

 private:
  RecordingWriter writer_;
  bool has_unflushed_ = false;
  std::chrono::steady_clock::time_point flushed_ = std::chrono::steady_clock::now();
};

}  // namespace

std::unique_ptr<LiveSink> create_live_file(const std::string& path, const LiveSinkInfo& info) {
  ForceFileInfo forces = info.forces;
  if (!is_hdf5_name(path)) forces.contacts.reset();  // Forces alone.
  auto file = create_force_sink(path, forces, info.replace);
  return std::make_unique<QueuedSink>(path,
                                      std::make_unique<FileConsumer>(std::move(file), forces));
}

std::unique_ptr<LiveSink> create_live_recording(const std::string& path, const LiveSinkInfo& info) {
  return std::make_unique<QueuedSink>(path, std::make_unique<RecordingConsumer>(path, info));
}

}  // namespace pillarfield
