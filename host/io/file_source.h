#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/plain/number_array.h"
#include "io/stored_skin.h"
#include "pillarfield/recording.h"

namespace pillarfield {

/// The part of FrameSource that all file formats share.
class FileSource : public FrameSource {
 public:
  [[nodiscard]] const std::string& format() const override { return format_; }
  [[nodiscard]] const Skin& skin() const override { return skin_; }
  [[nodiscard]] SenselType sensel_type() const override { return type_; }
  [[nodiscard]] std::uint64_t frames() const override { return frames_; }
  [[nodiscard]] const Calibration& calibration() const override { return calibration_; }
  [[nodiscard]] bool has_truth() const override { return false; }
  void warn(std::string sentence) { warnings_.push_back(std::move(sentence)); }
  [[nodiscard]] const std::vector<std::string>& warnings() const override { return warnings_; }
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }
  void read_truth(std::uint64_t index, ForceField& truth) override;

  /// ReadOptions::tare_frames. Throws Error if the file has fewer, or as take_tare() does.
  void measure_tare(const ReadOptions& options);

 protected:
  FileSource(std::filesystem::path path, std::string format);

  void require_frame(std::uint64_t index) const;
  void require_fitting(const FrameBuffer& frame) const;

  /// Sets the constants of the skin: those of the options, else those of the file, else the
  /// defaults, with a warning.
  void take_constants(const StoredSkin& stored, const ReadOptions& options);

  /// Sets the times of a file that stores none. Throws Error if they are used and no rate is given.
  void assume_times(const ReadOptions& options, const char* failure = "has no times of its frames");
  [[nodiscard]] double assumed_time(std::uint64_t index) const;
  /// Throws Error if a rate is given to a file with times.
  void require_no_rate(const ReadOptions& options) const;

  /// Converts the numbers of frame `index`. Throws Error if float32 does not hold one exactly.
  void take_readings(NumberType type, const std::byte* numbers, std::uint64_t index,
                     FrameBuffer& frame) const;

  /// Adds the size_warnings(), and one of a file without frames.
  void warn_of_size();

  std::filesystem::path path_;
  std::string format_;
  Skin skin_;
  SenselType type_ = SenselType::u8;
  std::uint64_t frames_ = 0;
  Calibration calibration_;
  std::vector<std::string> warnings_;
  std::vector<std::string> notes_;

 private:
  std::optional<double> rate_hz_;
  bool mirrors_ = false;  // falling readings
};

/// Checks that the times of all frames are finite and rise.
class RisingTimes {
 public:
  /// `before_s`: the time before the first frame.
  explicit RisingTimes(std::string place,
                       double before_s = -std::numeric_limits<double>::infinity())
      : place_(std::move(place)), before_s_(before_s) {}

  /// Adds the times of the next frames. Throws Error, naming the frame, if one does not rise.
  void add(std::span<const double> times_s);

 private:
  std::string place_;
  std::uint64_t frames_ = 0;
  double before_s_;
};

}  // namespace pillarfield
