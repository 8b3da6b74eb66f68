#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/force_format.h"
#include "io/force_planes.h"
#include "io/force_sink.h"
#include "io/hdf5/contact_hdf5_tables.h"
#include "io/hdf5/file.h"
#include "io/hdf5/force_info.h"
#include "io/hdf5/frames.h"
#include "io/hdf5/tiled_frames.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kFlushEvery = 16;  // frames

class Hdf5Sink final : public ForceSink {
 public:
  Hdf5Sink(const std::filesystem::path& path, ForceFileInfo info, Replace replace);
  ~Hdf5Sink() override;

  void append(const SolvedFrame& frame) override;
  void finish() override;

 private:
  void create_datasets(const SolvedFrame* first);
  void require_open() const;
  void put(const SolvedFrame& frame);
  void flush();

  ForceFileInfo info_;
  FramePlanes frame_planes_;
  std::filesystem::path path_;
  OutputFile part_;
  hdf5::File file_;
  std::vector<hdf5::TiledFrames> planes_;  // in the order of frame_planes_.planes()
  hdf5::TiledFrames status_;
  hdf5::ExtendibleDataset time_;
  ContactTables contacts_;
  std::uint64_t frames_ = 0;
  std::uint64_t flushed_ = 0;
};

Hdf5Sink::Hdf5Sink(const std::filesystem::path& path, ForceFileInfo info, Replace replace)
    : info_(std::move(info)),
      frame_planes_(info_),
      path_(path),
      part_(path, OutputKind::forces, replace),
      file_(hdf5::create(part_)) {
  write_info(file_, info_, path_);
}

Hdf5Sink::~Hdf5Sink() {
  const hdf5::QuietErrors quiet;
  if (flushed_ > 0) part_.keep();
  planes_.clear();
  status_ = {};
  time_ = {};
  contacts_ = {};
  file_ = {};
}

/// Value of a plane in pillars that nothing touches: with angles and uncertainty it is not zero.
float idle_value(std::span<const float> plane, std::span<const std::uint8_t> status) {
  const auto idle = std::ranges::find(status, std::uint8_t{0});
  return idle == status.end() ? 0.0F : plane[static_cast<std::size_t>(idle - status.begin())];
}

/// Noise that loads most pillars does so in every frame; a touch does not.
hdf5::Tiling tiling_for(std::span<const std::uint8_t> status) {
  const auto idle = static_cast<std::size_t>(std::ranges::count(status, std::uint8_t{0}));
  return 2 * idle < status.size() ? hdf5::Tiling::strips : hdf5::Tiling::squares;
}

/// Creates the datasets for frames like `first`, if there is one.
void Hdf5Sink::create_datasets(const SolvedFrame* first) {
  const hdf5::Handle force = hdf5::create_group(file_, force_format::kForce);
  const hdf5::Handle uncertainty =
      info_.uncertainty ? hdf5::create_group(file_, force_format::kUncertainty) : hdf5::Handle();
  if (first != nullptr) frame_planes_.set_frame(first->forces);
  const auto tiling = first == nullptr ? hdf5::Tiling::squares : tiling_for(first->forces.status);
  for (const ResultPlane& plane : frame_planes_.planes()) {
    const std::string name = fmt::format("/{}/{}", plane.group(), plane.name);
    const float fill =
        first == nullptr ? 0.0F : idle_value(frame_planes_.of(plane), first->forces.status);
    planes_.emplace_back(file_, name.c_str(), H5T_IEEE_F32LE, info_.rows, info_.cols, &fill, tiling,
                         info_.frames);
  }
  write_pressure_unit(file_, info_);
  constexpr std::uint8_t kIdle = 0;
  status_ = {file_,  force_format::kStatus, H5T_STD_U8LE, info_.rows, info_.cols, &kIdle,
             tiling, info_.frames};
  time_ = {file_, force_format::kTime, H5T_IEEE_F64LE, {}};
  if (info_.contacts) contacts_ = {file_, *info_.contacts};
  hdf5::start_appending(file_);
}

void Hdf5Sink::require_open() const {
  if (file_.id.valid()) return;
  throw Error(path_.string(), "is finished", "start another file");
}

void Hdf5Sink::put(const SolvedFrame& frame) {
  std::size_t index = 0;
  frame_planes_.set_frame(frame.forces);
  for (const ResultPlane& plane : frame_planes_.planes()) {
    planes_[index++].append(frame_planes_.of(plane).data());
  }
  status_.append(frame.forces.status.data());
  time_.put(frames_, H5T_NATIVE_DOUBLE, &frame.time_s);
  if (info_.contacts) contacts_.append(*frame.contacts);
}

void Hdf5Sink::flush() {
  for (auto& plane : planes_) plane.flush();
  status_.flush();
  if (info_.contacts) contacts_.write();
  hdf5::flush(file_, frames_);
  flushed_ = frames_;
  part_.sync_at_intervals();
}

void Hdf5Sink::append(const SolvedFrame& frame) {
  const hdf5::QuietErrors quiet;
  require_open();
  check(frame, info_, path_.string());
  if (planes_.empty()) create_datasets(&frame);
  put(frame);
  ++frames_;
  if (frames_ % kFlushEvery == 0) flush();
}

void Hdf5Sink::finish() {
  const hdf5::QuietErrors quiet;
  require_open();
  if (planes_.empty()) create_datasets(nullptr);
  flush();
  for (auto& plane : planes_) plane.close();
  status_.close();
  time_.close();
  contacts_.close();
  hdf5::close(file_);
  part_.commit();
}

}  // namespace

SinkFormat force_hdf5_format() {
  return {.kind = OutputKind::forces,
          .extensions = {".h5", ".hdf5"},
          .content = "holds force fields",
          .create = [](const std::filesystem::path& path, const ForceFileInfo& info,
                       Replace replace) -> std::unique_ptr<ForceSink> {
            const hdf5::QuietErrors quiet;
            return std::make_unique<Hdf5Sink>(path, info, replace);
          }};
}

}  // namespace pillarfield
