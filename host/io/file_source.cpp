#include "io/file_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "calibration/wire_correction.h"
#include "pillarfield/array_axes.h"
#include "pillarfield/error.h"
#include "pillarfield/tare.h"
#include "skin/raw_reading.h"

namespace pillarfield {

FileSource::FileSource(std::filesystem::path path, std::string format)
    : path_(std::move(path)), format_(std::move(format)) {}

void FileSource::read_truth(std::uint64_t, ForceField&) {
  throw Error(path_.string(), "holds no true forces", "call has_truth() first");
}

void FileSource::require_frame(std::uint64_t index) const {
  if (index < frames_) return;
  throw Error(path_.string(), fmt::format("has no frame {}", index),
              fmt::format("it holds {}, counted from 0", counted(frames_, "frame")));
}

void FileSource::require_fitting(const FrameBuffer& frame) const {
  const FrameView view = frame.view();
  if (view.type == type_ && view.rows == skin_.rows && view.cols == skin_.cols) return;
  throw Error(path_.string(),
              fmt::format("its frames do not fit a buffer of {} x {} {}", view.rows, view.cols,
                          name_of(view.type)),
              fmt::format("make it {} x {} {}", skin_.rows, skin_.cols, name_of(type_)));
}

void FileSource::take_constants(const StoredSkin& stored, const ReadOptions& options) {
  pillarfield::take_constants(skin_, stored, options);
  const auto tell = [&](const char* name, bool is_known, double value) {
    if (is_known) return;
    warnings_.push_back(fmt::format("The file has no {}; {} is assumed.", name, value));
  };
  tell("sensel_pitch_mm", skin_.stated.sensel_pitch, skin_.sensel_pitch_mm.col_mm);
  tell("counts_per_newton", skin_.stated.counts_per_newton, skin_.counts_per_newton);
  tell("threshold_counts",
       options.tare_frames > 0 || options.threshold_counts || stored.threshold_counts,
       skin_.threshold_counts);
  mirrors_ = options.falling && !stored.falling;
}

void FileSource::assume_times(const ReadOptions& options, const char* failure) {
  if (options.rate_hz && !(*options.rate_hz > 0 && std::isfinite(*options.rate_hz))) {
    throw Error(path_.string(), fmt::format("a rate of {} Hz is given", *options.rate_hz),
                "it must be above zero");
  }
  rate_hz_ = options.rate_hz;
  assumes_times_ = true;
  if (rate_hz_ || options.untimed || frames_ <= 1) return;
  throw Error(path_.string(), failure, "give their rate with --rate HZ");
}

double FileSource::assumed_time(std::uint64_t index) const {
  if (rate_hz_) return static_cast<double>(index) / *rate_hz_;
  return frames_ <= 1 ? 0 : std::numeric_limits<double>::quiet_NaN();
}

bool FileSource::replaces_times(const TimeOrder& order, const ReadOptions& options) {
  const bool is_given = options.rate_hz.has_value();
  if (order.rises()) {
    if (!is_given || options.untimed) return false;
    throw Error(path_.string(), "has times of its frames", "leave out --rate");
  }
  warnings_.push_back(fmt::format(
      "{}; {}.", order.faults(),
      is_given ? fmt::format("frames are {:.6g} s apart instead", 1 / *options.rate_hz)
               : "frames and times are kept in the order of the file (--rate HZ replaces them)"));
  if (is_given) assume_times(options);
  return is_given;
}

void FileSource::settle_times(std::vector<double>& times_s, const ReadOptions& options) {
  TimeOrder order(path_.string());
  order.add(times_s);
  if (replaces_times(order, options)) times_s.clear();
}

void FileSource::take_readings(NumberType type, const std::byte* numbers, std::uint64_t index,
                               FrameBuffer& frame) const {
  const auto inexact = convert_to_readings(type, numbers, skin_.sensels(), frame.bytes().data());
  if (!inexact && mirrors_) mirror(frame);
  if (!inexact) return;
  throw Error(path_.string(),
              fmt::format("frame {}, row {}, column {} holds an {} beyond ±16777216", index,
                          *inexact / skin_.cols, *inexact % skin_.cols, name_of(type)),
              "store readings as float32");
}

std::vector<SenselEvidence> FileSource::looked_at(std::uint64_t looks) {
  std::vector<SenselEvidence> sensels(skin_.sensels());
  FrameBuffer frame(type_, skin_.rows, skin_.cols);
  const bool mirrors = std::exchange(mirrors_, false);
  for (std::uint64_t look = 0; look < looks; ++look) {
    read(look * frames_ / looks, frame);
    for (std::size_t i = 0; i < sensels.size(); ++i) {
      const auto row = i / skin_.cols;
      sensels[i].read.add(raw_reading(frame.view(), row, i - row * skin_.cols),
                          std::numeric_limits<float>::infinity());
    }
  }
  mirrors_ = mirrors;
  return sensels;
}

void FileSource::note_absent() {
  constexpr std::uint64_t kLeastAbsentLooks = 10;
  constexpr std::uint64_t kMostLooks = 64;
  const std::uint64_t looks = std::min(frames_, kMostLooks);
  if (looks < kLeastAbsentLooks || !absent_value(looked_at(looks))) return;
  const std::vector<SenselEvidence> sensels = looked_at(frames_);
  const std::optional<float> value = absent_value(sensels);
  if (!value) return;
  calibration_.mask.assign(sensels.size(), kGood);
  for (std::size_t i = 0; i < sensels.size(); ++i) {
    if (sensels[i].is_constant() && sensels[i].read.lowest == *value)
      calibration_.mask[i] = kAbsent;
  }
  warnings_.push_back(fmt::format("{} of {} cells always read {} and have no sensel.",
                                  count_absent(calibration_), sensels.size(), *value));
}

void FileSource::measure_tare(const ReadOptions& options) {
  if (options.tare_frames > frames_) {
    throw Error(path_.string(), "has " + counted(frames_, "frame"),
                fmt::format("give a --tare-frames below {}", options.tare_frames));
  }
  WireCorrection correct(path_.string(), skin_, type_, calibration_.effects.wires, {});
  TareFrames unloaded(path_.string(), correct.skin(), correct.type());
  FrameBuffer frame(type_, skin_.rows, skin_.cols);
  for (std::uint64_t index = 0; index < options.tare_frames; ++index) {
    read(index, frame);
    unloaded.add(correct(frame.view()));
  }
  SkinCalibration before = blank_calibration(skin_);
  before.planes = calibration_;
  before.counts_per_newton = skin_.counts_per_newton;
  before.power_law = skin_.power_law;
  const TareResult tare =
      take_tare(before, unloaded, {.otherwise = "take it by calibrate tare with --preloaded"});
  apply(tare.calibration, skin_, calibration_);
  if (options.threshold_counts) skin_.threshold_counts = *options.threshold_counts;
  notes_.push_back(fmt::format(
      "Tare and noise are those of the first {} frames; readings above {:.4g} counts are usable.",
      options.tare_frames, skin_.threshold_counts));
  if (tare.findings.empty()) return;
  warnings_.push_back(
      fmt::format("{} sensels read as faulty in the first {} frames and are masked.",
                  tare.findings.size(), options.tare_frames));
}

void TimeOrder::add(std::span<const double> times_s) {
  for (const double time_s : times_s) {
    if (!std::isfinite(time_s)) {
      throw Error(place_, fmt::format("frame {} has the time {}", frames_, time_s),
                  "store finite seconds");
    }
    if (time_s <= before_s_) {
      if (rises()) first_fault_ = frames_;
      ++(time_s == before_s_ ? ties_ : steps_back_);
    }
    before_s_ = time_s;
    ++frames_;
  }
}

std::string TimeOrder::faults() const {
  const auto count = [](std::uint64_t times, const char* one, const char* many) {
    return fmt::format("{} {}", times, times == 1 ? one : many);
  };
  std::string text;
  if (ties_ > 0) text = count(ties_, "time equals the one before", "times equal the one before");
  if (ties_ > 0 && steps_back_ > 0) text += ", ";
  if (steps_back_ > 0) text += count(steps_back_, "time steps back", "times step back");
  return fmt::format("{}, first at frame {}", text, first_fault_);
}

void FileSource::warn_of_size() {
  if (skin_.has_pillars()) {
    std::ranges::move(size_warnings(skin_.rows, skin_.cols), std::back_inserter(warnings_));
  }
  if (frames_ == 0) warnings_.emplace_back("The file holds no frames.");
}

}  // namespace pillarfield
