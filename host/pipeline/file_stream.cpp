#include <algorithm>

#include "pillarfield/frame_stream.h"

namespace pillarfield {
namespace {

class FileStream final : public FrameStream {
 public:
  FileStream(FrameSource& source, std::uint64_t first, std::uint64_t end)
      : source_(source), next_(first), end_(end) {}

  [[nodiscard]] const Skin& skin() const override { return source_.skin(); }
  [[nodiscard]] SenselType sensel_type() const override { return source_.sensel_type(); }
  [[nodiscard]] const Calibration& calibration() const override { return source_.calibration(); }

  [[nodiscard]] Arrival next(StreamedFrame& frame, std::chrono::nanoseconds) override {
    frame.sequence = next_;
    if (next_ >= std::min(end_, source_.frames())) return Arrival::ended;
    frame.time_s = source_.read(next_++, frame.buffer);
    frame.readings = frame.buffer.view();
    frame.missing.clear();
    frame.arrived = std::chrono::steady_clock::now().time_since_epoch();
    return Arrival::arrived;
  }

 private:
  FrameSource& source_;
  std::uint64_t next_;
  std::uint64_t end_;
};

}  // namespace

std::unique_ptr<FrameStream> file_stream(FrameSource& source, std::uint64_t first,
                                         std::uint64_t end) {
  return std::make_unique<FileStream>(source, first, end);
}

}  // namespace pillarfield
