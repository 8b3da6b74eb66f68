#include <fmt/format.h>

#include <iterator>

#include "io/force_planes.h"
#include "io/force_sink.h"
#include "io/output/text_part.h"

namespace pillarfield {
namespace {

constexpr std::string_view kForceCsvHead = "frame,time_s,row,col,";

/// Writes one line per pillar with nonzero status, numbers in the fewest digits that read back as
/// the same value.
class ForceCsvSink final : public ForceSink {
 public:
  ForceCsvSink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace,
               std::uint64_t first_frame = 0);

  void append(const SolvedFrame& frame) override;
  void finish() override { file_.finish(); }

 private:
  void add_line(const ForceFieldView& forces, std::size_t pillar);

  ForceFileInfo info_;
  FramePlanes frame_planes_;
  std::filesystem::path path_;
  TextPart file_;
  fmt::memory_buffer line_;
  std::string frame_cells_;  // "frame,time,", shared by all lines of a frame
  std::uint64_t frame_;      // next frame
};

ForceCsvSink::ForceCsvSink(const std::filesystem::path& path, const ForceFileInfo& info,
                           Replace replace, std::uint64_t first_frame)
    : info_(info),
      frame_planes_(info),
      path_(path),
      file_(path, OutputKind::forces, replace),
      frame_(first_frame) {
  file_.write("frame,time_s,row,col");
  for (const ResultPlane& plane : frame_planes_.planes()) {
    file_.write(fmt::format(",{}_{}", plane.field(), plane.unit));
    if (plane.index + 1 == kForcePlanes) file_.write(",status");
  }
  file_.write("\n");
}

void ForceCsvSink::add_line(const ForceFieldView& forces, std::size_t pillar) {
  line_.clear();
  line_.append(frame_cells_);
  const auto out = std::back_inserter(line_);
  fmt::format_to(out, "{},{}", pillar / info_.cols, pillar % info_.cols);
  for (const ResultPlane& plane : frame_planes_.planes()) {
    fmt::format_to(out, ",{}", frame_planes_.of(plane)[pillar]);
    if (plane.index + 1 == kForcePlanes) fmt::format_to(out, ",{}", forces.status[pillar]);
  }
  line_.push_back('\n');
  file_.write(std::string_view(line_.data(), line_.size()));
}

void ForceCsvSink::append(const SolvedFrame& frame) {
  file_.require_open();
  check(frame, info_, path_.string());
  const ForceFieldView& forces = frame.forces;
  frame_planes_.set_frame(forces);
  frame_cells_ = fmt::format("{},{},", frame_, frame.time_s);
  for (std::size_t pillar = 0; pillar < forces.status.size(); ++pillar) {
    if (forces.status[pillar] != 0) add_line(forces, pillar);
  }
  ++frame_;
}

}  // namespace

SinkFormat force_csv_format() {
  return {.kind = OutputKind::forces,
          .extensions = {".csv"},
          .content = "is a table of forces",
          .begins = kForceCsvHead,
          .create = create_sink<ForceCsvSink>};
}

void write_force_csv(const std::filesystem::path& path, const ForceFileInfo& info,
                     const ForceFieldView& forces, std::uint64_t frame, double time_s,
                     Replace replace) {
  ForceCsvSink sink(path, info, replace, frame);
  sink.append({.forces = forces, .contacts = nullptr, .time_s = time_s});
  sink.finish();
}

}  // namespace pillarfield
