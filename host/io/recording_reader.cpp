#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "io/file_source.h"
#include "io/hdf5/file.h"
#include "io/hdf5/links.h"
#include "io/hdf5/number_type.h"
#include "io/hdf5/readers.h"
#include "io/hdf5/stored_frames.h"
#include "io/recording_format.h"
#include "io/stored_skin.h"
#include "io/stored_surface.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

class Recording final : public FileSource {
 public:
  explicit Recording(hdf5::File file);

  [[nodiscard]] bool has_truth() const override { return !truth_.empty(); }
  double time(std::uint64_t index) override;
  double read(std::uint64_t index, FrameBuffer& frame) override;
  void read_truth(std::uint64_t index, ForceField& truth) override;

 private:
  void read_size();
  void take_skin();
  void open_truth();
  void count_frames();
  [[nodiscard]] std::string place(const char* object) const;

  hdf5::File file_;
  hdf5::StoredFrames raw_;
  hdf5::StoredFrames time_;
  std::vector<hdf5::StoredFrames> truth_;  // empty, or shear_x, shear_y, normal
};

SenselType sensel_type_of(const hdf5::StoredFrames& raw, const std::filesystem::path& path) {
  const std::string type = hdf5::name_of_type(raw.type());
  for (const SenselType each : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    if (type == name_of(each)) return each;
  }
  throw Error(path.string(),
              fmt::format("{} is {}, which is not a type of readings", raw.name(), type),
              "store uint8, uint16 or float32");
}

void require_floats(const hdf5::StoredFrames& frames, const std::filesystem::path& path) {
  if (frames.value_class() == H5T_FLOAT) return;
  throw Error(
      path.string(),
      fmt::format("{} must hold floats, not {}", frames.name(), hdf5::name_of_type(frames.type())),
      "store floats");
}

Recording::Recording(hdf5::File file) : FileSource(file.path, "recording"), file_(std::move(file)) {
  hdf5::require_format(file_, recording_format::kName, recording_format::kVersion);
  raw_ = {file_, recording_format::kRaw, 2};
  time_ = {file_, recording_format::kTime, 0};
  require_floats(time_, path_);
  type_ = sensel_type_of(raw_, path_);
  read_size();
  take_skin();
  calibration_ = read_planes(file_, skin_, type_);
  open_truth();
  count_frames();
  warn_of_size();
}

std::string Recording::place(const char* object) const {
  return fmt::format("{}: {}", path_.string(), object);
}

void Recording::read_size() {
  const auto shape = raw_.shape();
  for (const hsize_t size : shape) {
    if (size >= 2 && size <= kMaxSensels) continue;
    throw Error(place(recording_format::kRaw),
                fmt::format("its frames are {} x {}", shape[0], shape[1]),
                fmt::format("rows and columns must lie in [2, {}]", kMaxSensels));
  }
  skin_.rows = static_cast<std::uint32_t>(shape[0]);
  skin_.cols = static_cast<std::uint32_t>(shape[1]);
}

void Recording::take_skin() {
  const StoredSkin stored = read_skin(file_);
  const auto take = [&](const char* name, const std::optional<double>& constant, double& value) {
    if (constant) {
      value = *constant;
    } else {
      warnings_.push_back(fmt::format("The file has no {}; {} is assumed.", name, value));
    }
  };
  take(recording_format::kPitch, stored.sensel_pitch_mm, skin_.sensel_pitch_mm);
  take(recording_format::kCountsPerNewton, stored.counts_per_newton, skin_.counts_per_newton);
  take(recording_format::kThreshold, stored.threshold_counts, skin_.threshold_counts);
  skin_.full_scale_counts = stored.full_scale_counts;
  skin_.power_law = stored.power_law;
  skin_.surface = read_surface(file_, skin_.pillar_layout());
  check(skin_, place(recording_format::kSkin).c_str());
}

void Recording::open_truth() {
  if (!hdf5::exists(file_, recording_format::kTruth)) return;
  for (const char* name : recording_format::kTruthPlanes) {
    truth_.emplace_back(file_, name, 2);
    require_floats(truth_.back(), path_);
    const auto shape = truth_.back().shape();
    if (shape[0] == skin_.pillar_rows() && shape[1] == skin_.pillar_cols()) continue;
    throw Error(place(name), fmt::format("its frames are {} x {}", shape[0], shape[1]),
                fmt::format("they need {} x {} pillars", skin_.pillar_rows(), skin_.pillar_cols()));
  }
}

void Recording::count_frames() {
  std::uint64_t most = std::max(raw_.frames(), time_.frames());
  frames_ = std::min(raw_.frames(), time_.frames());
  for (const auto& plane : truth_) {
    most = std::max(most, plane.frames());
    frames_ = std::min(frames_, plane.frames());
  }
  if (file_.unclosed) {
    warnings_.push_back(fmt::format(
        "The file was not closed: its writer was killed or is still running. The {} flushed frames "
        "are read.",
        frames_));
  } else if (most != frames_) {
    warnings_.push_back(
        fmt::format("The datasets of the file have {} to {} frames; only the first {} are read.",
                    frames_, most, frames_));
  }
}

double Recording::time(std::uint64_t index) {
  const hdf5::QuietErrors quiet;
  require_frame(index);
  double time_s = 0;
  time_.get(index, H5T_NATIVE_DOUBLE, &time_s);
  if (!std::isfinite(time_s)) {
    throw Error(place(recording_format::kTime),
                fmt::format("frame {} has the time {}", index, time_s), "store finite seconds");
  }
  return time_s;
}

double Recording::read(std::uint64_t index, FrameBuffer& frame) {
  const hdf5::QuietErrors quiet;
  require_fitting(frame);
  const double time_s = time(index);
  raw_.get(index, recording_format::memory_type_of(type_), frame.bytes().data());
  return time_s;
}

void Recording::read_truth(std::uint64_t index, ForceField& truth) {
  const hdf5::QuietErrors quiet;
  if (!has_truth()) FileSource::read_truth(index, truth);
  require_frame(index);
  truth.rows = skin_.pillar_rows();
  truth.cols = skin_.pillar_cols();
  const std::array planes = {&truth.shear_x, &truth.shear_y, &truth.normal};
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    planes[plane]->resize(skin_.pillars());
    truth_[plane].get(index, H5T_NATIVE_FLOAT, planes[plane]->data());
  }
}

}  // namespace

std::unique_ptr<FrameSource> read_recording(hdf5::File file) {
  return std::make_unique<Recording>(std::move(file));
}

}  // namespace pillarfield
