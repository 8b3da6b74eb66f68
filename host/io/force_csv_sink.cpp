#include <fmt/format.h>

#include <iterator>

#include "io/force_planes.h"
#include "io/force_sink.h"
#include "io/output_file.h"
#include "io/part_file.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kBufferBytes = 1 << 20;

/// One line per pillar with a status other than 0; numbers in the fewest digits that read back
/// as the same value.
class CsvSink final : public ForceSink {
 public:
  CsvSink(const std::filesystem::path& path, const ForceFileInfo& info);

  void append(const ForceFieldView& forces, double time_s) override;
  void finish() override;

 private:
  void add_line(const ForceFieldView& forces, std::size_t pillar);
  void write_out();
  void require_open() const;

  ForceFileInfo info_;
  std::vector<ForcePlane> further_;
  std::filesystem::path path_;
  PartFile part_;
  OutputFile file_;
  fmt::memory_buffer text_;
  std::string frame_cells_;  // "frame,time,", the same on each line of a frame
  std::uint64_t frames_ = 0;
};

CsvSink::CsvSink(const std::filesystem::path& path, const ForceFileInfo& info)
    : info_(info), further_(further_planes(info)), path_(path), part_(path), file_(part_.path()) {
  file_.write("frame,time_s,row,col,shear_x_n,shear_y_n,normal_n,status");
  for (const ForcePlane& plane : further_) {
    file_.write(fmt::format(",{}_{}", plane.field(), plane.unit));
  }
  file_.write("\n");
}

void CsvSink::add_line(const ForceFieldView& forces, std::size_t pillar) {
  text_.append(frame_cells_);
  const auto out = std::back_inserter(text_);
  fmt::format_to(out, "{},{},{},{},{},{}", pillar / info_.cols, pillar % info_.cols,
                 forces.shear_x[pillar], forces.shear_y[pillar], forces.normal[pillar],
                 forces.status[pillar]);
  for (const ForcePlane& plane : further_) {
    fmt::format_to(out, ",{}", plane.values(forces)[pillar]);
  }
  text_.push_back('\n');
}

void CsvSink::write_out() {
  file_.write(std::string_view(text_.data(), text_.size()));
  text_.clear();
}

void CsvSink::require_open() const {
  if (file_.is_open()) return;
  throw Error(path_.string(), "is finished", "start another file");
}

void CsvSink::append(const ForceFieldView& forces, double time_s) {
  require_open();
  check(forces, time_s, info_, path_.string());
  frame_cells_ = fmt::format("{},{},", frames_, time_s);
  for (std::size_t pillar = 0; pillar < forces.status.size(); ++pillar) {
    if (forces.status[pillar] == 0) continue;
    add_line(forces, pillar);
    if (text_.size() >= kBufferBytes) write_out();
  }
  ++frames_;
}

void CsvSink::finish() {
  require_open();
  write_out();
  file_.close();
  part_.commit();
}

}  // namespace

std::unique_ptr<ForceSink> create_csv_sink(const std::filesystem::path& path,
                                           const ForceFileInfo& info) {
  return std::make_unique<CsvSink>(path, info);
}

}  // namespace pillarfield
