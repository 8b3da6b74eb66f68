#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/doctor/frame_watch.h"
#include "pillarfield/frame.h"

namespace pillarfield {

inline constexpr std::size_t kMostKeptFrames = 4096;
inline constexpr std::size_t kMostKeptReadings = std::size_t{1} << 25U;
inline constexpr std::size_t kLeastKeptFrames = 16;

/// A sensel's readings, and the kept frames that have one.
struct SenselReadings {
  std::vector<float> values;
  std::vector<std::uint32_t> frames;
};

/// Frames of an unlimited number of frames, evenly thinned: when they are too many, every second
/// one is dropped.
class KeptFrames {
 public:
  KeptFrames(std::uint32_t rows, std::uint32_t cols);

  void add(const FrameView& frame, double time_s, FrameKind kind);
  /// Drops the frames of a kind.
  void drop(FrameKind kind);

  [[nodiscard]] std::size_t frames() const { return times_.size(); }
  /// One of so many frames is kept.
  [[nodiscard]] std::uint64_t stride() const { return stride_; }
  /// The number of a kept frame among all, from 0.
  [[nodiscard]] std::uint64_t number(std::size_t index) const { return numbers_[index]; }
  [[nodiscard]] std::size_t sensels() const { return sensels_; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  void read_sensel(std::size_t sensel, SenselReadings& to) const;
  /// Readings of a frame, [row, col]; NaN where there is none.
  [[nodiscard]] std::span<float> frame(std::size_t index) {
    return {&readings_[index * sensels_], sensels_};
  }
  [[nodiscard]] std::span<const float> frame(std::size_t index) const {
    return {&readings_[index * sensels_], sensels_};
  }

 private:
  template <class Keep>
  void keep(Keep is_kept);

  std::size_t sensels_;
  std::size_t most_;
  std::uint64_t added_ = 0;
  std::uint64_t stride_ = 1;
  std::vector<float> readings_;
  std::vector<double> times_;
  std::vector<std::uint64_t> numbers_;
  std::vector<FrameKind> kinds_;
};

}  // namespace pillarfield
