#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "io/file_source.h"
#include "io/hdf5/dataset.h"
#include "io/hdf5/file.h"
#include "io/hdf5/handle.h"
#include "io/hdf5/readers.h"
#include "io/hdf5/stored_frames.h"
#include "io/recording_format.h"
#include "io/stored_skin.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

class Recording final : public FileSource {
 public:
  Recording(hdf5::File file, const ReadOptions& options);

  [[nodiscard]] bool has_truth() const override { return !truth_.empty(); }
  double time(std::uint64_t index) override;
  double read(std::uint64_t index, FrameBuffer& frame) override;
  void read_truth(std::uint64_t index, ForceField& truth) override;

 private:
  void read_size();
  void take_skin(const ReadOptions& options);
  void open_times();
  void check_times(const ReadOptions& options);
  void open_truth();
  void count_frames();
  void warn_of_missing();
  [[nodiscard]] std::string place(const char* object) const;

  hdf5::File file_;
  int version_;
  hdf5::StoredFrames raw_;
  NumberType number_;                       // of the readings
  std::vector<std::byte> numbers_;          // of a frame, unless they are readings
  std::optional<hdf5::StoredFrames> time_;  // unset: see assumed_time()
  std::vector<hdf5::StoredFrames> truth_;   // empty, or shear_x, shear_y, normal; normal alone
  bool is_other_layout_ = false;            // than the truth has
  bool falls_as_stored_ = false;            // the file says that its readings were mirrored
};

void require_floats(const hdf5::StoredFrames& frames, const std::filesystem::path& path) {
  if (frames.value_class() == H5T_FLOAT) return;
  throw Error(
      path.string(),
      fmt::format("{} must hold floats, not {}", frames.name(), hdf5::name_of_type(frames.type())),
      "store floats");
}

Recording::Recording(hdf5::File file, const ReadOptions& options)
    : FileSource(file.path, "recording"),
      file_(std::move(file)),
      version_(
          hdf5::require_format(file_, recording_format::kName, recording_format::kNewestVersion)) {
  raw_ = {file_, recording_format::kRaw, 2};
  open_times();
  number_ = hdf5::number_type_of(raw_, file_);
  type_ = sensel_type_for(number_);
  read_size();
  take_skin(options);
  calibration_ = read_planes(file_, skin_, type_);
  // A live recording without a tare keeps room for its noise.
  if (std::ranges::all_of(calibration_.noise, [](float noise) { return noise == 0; })) {
    calibration_.noise.clear();
  }
  if (options.falling && !falls_as_stored_ && !calibration_.tare.empty()) {
    throw Error(path_.string(), "its tare is that of readings that rise under load",
                "leave out --falling");
  }
  open_truth();
  count_frames();
  check_times(options);
  warn_of_missing();
  warn_of_size();
}

void Recording::open_times() {
  if (!hdf5::exists(file_, recording_format::kTime)) return;
  time_.emplace(file_, recording_format::kTime, 0);
  require_floats(*time_, path_);
}

void Recording::check_times(const ReadOptions& options) {
  if (!time_) return assume_times(options, "has no /frames/time");
  constexpr std::uint64_t kBlock = 1U << 16U;
  TimeOrder order(place(recording_format::kTime));
  std::vector<double> times_s;
  for (std::uint64_t first = 0; first < frames_; first += kBlock) {
    times_s.resize(std::min(kBlock, frames_ - first));
    time_->get_all(first, times_s.size(), H5T_NATIVE_DOUBLE, times_s.data());
    order.add(times_s);
  }
  if (replaces_times(order, options)) time_.reset();
}

/// Float readings say so themselves.
void Recording::warn_of_missing() {
  if (type_ == SenselType::f32) return;
  if (!hdf5::exists(file_, recording_format::kMissing)) return;
  const hdf5::StoredFrames missing(file_, recording_format::kMissing, 0);
  constexpr std::uint64_t kBlock = 1U << 16U;
  const std::uint64_t frames = std::min(frames_, missing.frames());
  std::vector<double> sensels;
  std::uint64_t incomplete = 0;
  for (std::uint64_t first = 0; first < frames; first += kBlock) {
    sensels.resize(std::min(kBlock, frames - first));
    missing.get_all(first, sensels.size(), H5T_NATIVE_DOUBLE, sensels.data());
    incomplete += static_cast<std::uint64_t>(
        std::ranges::count_if(sensels, [](double count) { return count > 0; }));
  }
  if (incomplete == 0) return;
  warnings_.push_back(fmt::format(
      "{} of {} frames arrived incomplete: the sensels that did not arrive hold earlier readings.",
      incomplete, frames_));
}

std::string Recording::place(const char* object) const {
  return fmt::format("{}: {}", path_.string(), object);
}

void Recording::read_size() {
  const auto shape = raw_.shape();
  for (const hsize_t size : shape) {
    if (size >= 1 && size <= kMaxSensels) continue;
    throw Error(place(recording_format::kRaw),
                fmt::format("its frames are {} x {}", shape[0], shape[1]),
                fmt::format("rows and columns must lie in [1, {}]", kMaxSensels));
  }
  skin_.rows = static_cast<std::uint32_t>(shape[0]);
  skin_.cols = static_cast<std::uint32_t>(shape[1]);
}

void Recording::take_skin(const ReadOptions& options) {
  StoredSkin stored;
  read_skin(file_, stored);
  falls_as_stored_ = stored.falling;
  stored.layout = stored.layout.value_or(SkinLayout::pillars);
  take_constants(stored, options);
  is_other_layout_ = skin_.layout != stored.layout;
  skin_.surface = read_surface(file_, skin_.element_grid());
  check(skin_, place(kSkinGroup).c_str());
}

void Recording::open_truth() {
  if (!hdf5::exists(file_, recording_format::kTruth) || is_other_layout_) return;
  for (std::size_t plane = 0; plane < std::size(recording_format::kTruthPlanes); ++plane) {
    const char* const name = recording_format::kTruthPlanes[plane];
    if (!recording_format::has_truth_plane(skin_, plane)) continue;
    truth_.emplace_back(file_, name, 2, version_ >= recording_format::kSparseTruthSince);
    require_floats(truth_.back(), path_);
    const auto shape = truth_.back().shape();
    if (shape[0] == skin_.element_rows() && shape[1] == skin_.element_cols()) continue;
    throw Error(place(name), fmt::format("its frames are {} x {}", shape[0], shape[1]),
                fmt::format("they need {} x {} {}", skin_.element_rows(), skin_.element_cols(),
                            name_of(skin_.layout)));
  }
}

void Recording::count_frames() {
  const std::uint64_t times = time_ ? time_->frames() : raw_.frames();
  std::uint64_t most = std::max(raw_.frames(), times);
  frames_ = std::min({raw_.frames(), times, file_.readable_frames});
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
  if (!time_) return assumed_time(index);
  double time_s = 0;
  time_->get(index, H5T_NATIVE_DOUBLE, &time_s);
  return time_s;
}

double Recording::read(std::uint64_t index, FrameBuffer& frame) {
  const hdf5::QuietErrors quiet;
  require_fitting(frame);
  const double time_s = time(index);
  if (name_of(number_) == name_of(type_)) {
    raw_.get(index, hdf5::memory_type_of(number_), frame.bytes().data());
    return time_s;
  }
  numbers_.resize(skin_.sensels() * number_.bytes);
  raw_.get(index, hdf5::memory_type_of(number_), numbers_.data());
  take_readings(number_, numbers_.data(), index, frame);
  return time_s;
}

void Recording::read_truth(std::uint64_t index, ForceField& truth) {
  const hdf5::QuietErrors quiet;
  if (!has_truth()) FileSource::read_truth(index, truth);
  require_frame(index);
  truth.rows = skin_.element_rows();
  truth.cols = skin_.element_cols();
  const std::array planes = {&truth.shear_x, &truth.shear_y, &truth.normal};
  auto stored = truth_.begin();
  for (std::size_t plane = 0; plane < planes.size(); ++plane) {
    planes[plane]->resize(recording_format::has_truth_plane(skin_, plane) ? skin_.elements() : 0);
    if (planes[plane]->empty()) continue;
    stored++->get(index, H5T_NATIVE_FLOAT, planes[plane]->data());
  }
}

}  // namespace

std::unique_ptr<FileSource> read_recording(hdf5::File file, const ReadOptions& options) {
  return std::make_unique<Recording>(std::move(file), options);
}

}  // namespace pillarfield
