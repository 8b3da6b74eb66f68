#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "io/tekscan/header.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// A sequence of readings: counts, stored in one byte each until one needs two, or newtons.
class CompactReadings {
 public:
  void append(std::uint16_t counts);
  void append_force(float newtons) { newtons_.push_back(newtons); }

  [[nodiscard]] SenselType type() const;

  /// The readings in newtons; empty if they are counts.
  [[nodiscard]] std::span<float> newtons() { return newtons_; }

  /// Copies `count` readings of type() from `first` on.
  void copy(std::size_t first, std::size_t count, void* out) const;

 private:
  std::vector<std::uint8_t> narrow_;
  std::vector<std::uint16_t> wide_;  // used instead of narrow_ unless empty
  std::vector<float> newtons_;
};

/// Content of a Tekscan ASCII export.
struct TekscanExport {
  TekscanHeader header;
  CompactReadings readings;            ///< frame by frame, row by row; 0: no sensel
  std::vector<std::uint64_t> numbers;  ///< of the frames, increasing
  std::vector<double> times_s;         ///< of the frames; empty if they have none
  std::vector<std::uint8_t> mask;      ///< [rows, cols]; kAbsent where any frame has no sensel
};

/// Reads an export. Throws Error with the line, and for a cell the column, of the first mistake.
/// Memory: one or two bytes per reading, four if calibrated.
[[nodiscard]] TekscanExport parse_tekscan(const std::filesystem::path& path);

}  // namespace pillarfield
