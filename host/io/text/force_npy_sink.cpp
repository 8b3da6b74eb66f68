#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "base/npy.h"
#include "io/force_planes.h"
#include "io/force_sink.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

static_assert(std::endian::native == std::endian::little, "the file is little-endian");

// A multiple of 64 that holds all planes and any number of frames.
constexpr std::size_t kHeaderBytes = 1024;

/// In the header of every file.
constexpr std::string_view kNpyFields = "('normal', '<f4'), ('status', '|u1')";

/// Header of NumPy's format 1.0: magic, length of the rest, and a Python dictionary padded with
/// blanks to a fixed size.
std::string npy_header(const ForceFileInfo& info, std::uint64_t frames) {
  constexpr std::size_t kPreludeBytes = 10;
  constexpr std::size_t kDictionaryBytes = kHeaderBytes - kPreludeBytes;
  std::string fields;
  for (const ResultPlane& plane : planes_of(info)) {
    fields += fmt::format("{}('{}', '<f4')", fields.empty() ? "" : ", ", plane.field());
    if (plane.index + 1 == kForcePlanes) fields += ", ('status', '|u1')";
  }
  std::string dictionary =
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({}, {}, {})}}", fields,
                  frames, info.rows, info.cols);
  dictionary.resize(kDictionaryBytes - 1, ' ');
  std::string header(kNpyMagic);
  header += {'\x01', '\x00', static_cast<char>(kDictionaryBytes & 0xff),
             static_cast<char>(kDictionaryBytes >> 8)};
  return header + dictionary + '\n';
}

class NpySink final : public ForceSink {
 public:
  NpySink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace);

  void append(const SolvedFrame& frame) override;
  void finish() override;

 private:
  template <class T>
  void interleave(std::span<const T> plane, std::size_t field_offset);
  void require_open() const;

  ForceFileInfo info_;
  FramePlanes frame_planes_;
  std::filesystem::path path_;
  OutputFile file_;
  std::size_t record_bytes_;
  std::vector<std::byte> records_;  // one frame
  std::uint64_t frames_ = 0;
};

NpySink::NpySink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace)
    : info_(info),
      frame_planes_(info),
      path_(path),
      file_(path, OutputKind::forces, replace),
      record_bytes_(sizeof(float) * frame_planes_.planes().size() + 1),
      records_(record_bytes_ * info.rows * info.cols) {
  file_.write(npy_header(info_, 0));
}

template <class T>
void NpySink::interleave(std::span<const T> plane, std::size_t field_offset) {
  std::byte* out = records_.data() + field_offset;
  for (const T& value : plane) {
    std::memcpy(out, &value, sizeof value);
    out += record_bytes_;
  }
}

void NpySink::require_open() const {
  if (file_.is_open()) return;
  throw Error(path_.string(), "is finished", "start another file");
}

void NpySink::append(const SolvedFrame& frame) {
  require_open();
  check(frame, info_, path_.string());
  const ForceFieldView& forces = frame.forces;
  frame_planes_.set_frame(forces);
  std::size_t offset = 0;
  for (const ResultPlane& plane : frame_planes_.planes()) {
    interleave(frame_planes_.of(plane), offset);
    offset += sizeof(float);
    if (plane.index + 1 == kForcePlanes) interleave(forces.status, offset++);
  }
  file_.write(records_);
  ++frames_;
}

void NpySink::finish() {
  require_open();
  file_.write_at_begin(npy_header(info_, frames_));
  file_.commit();
}

}  // namespace

SinkFormat force_npy_format() {
  return {.kind = OutputKind::forces,
          .extensions = {".npy"},
          .content = "is an array of forces",
          .begins = kNpyMagic,
          .holds = kNpyFields,
          .create = create_sink<NpySink>};
}

}  // namespace pillarfield
