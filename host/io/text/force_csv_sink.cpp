#include <fmt/format.h>

#include <iterator>

#include "io/force_planes.h"
#include "io/force_sink.h"
#include "io/output/text_part.h"

namespace pillarfield {
namespace {

/// One line per pillar with a status other than 0; numbers in the fewest digits that read back
/// as the same value.
class ForceCsvSink final : public ForceSink {
 public:
  ForceCsvSink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace,
               std::uint64_t first_frame);

  void append(const ForceFieldView& forces, double time_s) override;
  void finish() override { file_.finish(); }

 private:
  void add_line(const ForceFieldView& forces, std::size_t pillar);

  ForceFileInfo info_;
  std::vector<ResultPlane> planes_;
  FramePlanes frame_planes_;
  std::filesystem::path path_;
  TextPart file_;
  fmt::memory_buffer line_;
  std::string frame_cells_;  // "frame,time,", the same on each line of a frame
  std::uint64_t frame_;      // the next
};

ForceCsvSink::ForceCsvSink(const std::filesystem::path& path, const ForceFileInfo& info,
                           Replace replace, std::uint64_t first_frame)
    : info_(info),
      planes_(planes_of(info)),
      frame_planes_(info),
      path_(path),
      file_(path, OutputKind::force_table, replace),
      frame_(first_frame) {
  file_.write("frame,time_s,row,col");
  for (const ResultPlane& plane : planes_) {
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
  for (const ResultPlane& plane : planes_) {
    fmt::format_to(out, ",{}", frame_planes_.of(plane)[pillar]);
    if (plane.index + 1 == kForcePlanes) fmt::format_to(out, ",{}", forces.status[pillar]);
  }
  line_.push_back('\n');
  file_.write(std::string_view(line_.data(), line_.size()));
}

void ForceCsvSink::append(const ForceFieldView& forces, double time_s) {
  file_.require_open();
  check(forces, time_s, info_, path_.string());
  frame_planes_.take(forces);
  frame_cells_ = fmt::format("{},{},", frame_, time_s);
  for (std::size_t pillar = 0; pillar < forces.status.size(); ++pillar) {
    if (forces.status[pillar] != 0) add_line(forces, pillar);
  }
  ++frame_;
}

}  // namespace

std::unique_ptr<ForceSink> create_csv_sink(const std::filesystem::path& path,
                                           const ForceFileInfo& info, Replace replace) {
  return std::make_unique<ForceCsvSink>(path, info, replace, 0);
}

void write_force_csv(const std::filesystem::path& path, const ForceFileInfo& info,
                     const ForceFieldView& forces, std::uint64_t frame, double time_s,
                     Replace replace) {
  ForceCsvSink sink(path, info, replace, frame);
  sink.append(forces, time_s);
  sink.finish();
}

}  // namespace pillarfield
