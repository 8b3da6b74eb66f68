#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/sensel_judge.h"
#include "io/plain/number_array.h"
#include "io/stored_skin.h"
#include "pillarfield/recording.h"

namespace pillarfield {

/// Counts times that do not rise from frame to frame.
class TimeOrder {
 public:
  explicit TimeOrder(std::string place) : place_(std::move(place)) {}

  /// Adds the times of the next frames. Throws Error, naming the frame, if one is not finite.
  void add(std::span<const double> times_s);

  [[nodiscard]] bool rises() const { return ties_ + steps_back_ == 0; }
  /// "9 times equal the one before, and 1 steps back, first at frame 5".
  [[nodiscard]] std::string faults() const;

 private:
  std::string place_;
  std::uint64_t frames_ = 0;
  double before_s_ = -std::numeric_limits<double>::infinity();
  std::uint64_t ties_ = 0;
  std::uint64_t steps_back_ = 0;
  std::uint64_t first_fault_ = 0;  // its frame
};

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

  /// True if the file has times of its frames.
  [[nodiscard]] bool states_times() const { return !assumes_times_; }

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
  /// Warns of times that tie or step back, and returns whether the rate of the options replaces
  /// them. Throws Error for a rate where the times rise.
  [[nodiscard]] bool replaces_times(const TimeOrder& order, const ReadOptions& options);
  /// The same for the times of all frames, which it empties if they are replaced.
  void settle_times(std::vector<double>& times_s, const ReadOptions& options);

  /// Converts the numbers of frame `index`. Throws Error if float32 does not hold one exactly.
  void take_readings(NumberType type, const std::byte* numbers, std::uint64_t index,
                     FrameBuffer& frame) const;

  /// Marks the cells whose reading stands for "no sensel".
  void note_absent();

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
  bool assumes_times_ = false;
  bool mirrors_ = false;  ///< falling readings

 private:
  /// Evidence of the sensels in so many of the frames, evenly spaced.
  [[nodiscard]] std::vector<SenselEvidence> looked_at(std::uint64_t looks);

  std::optional<double> rate_hz_;
};

}  // namespace pillarfield
