#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/tekscan/header.h"
#include "pillarfield/skin.h"

namespace pillarfield {

/// Readings one after the other, each in one byte until one needs two.
class CompactReadings {
 public:
  void append(std::uint16_t reading);

  [[nodiscard]] SenselType type() const { return wide_.empty() ? SenselType::u8 : SenselType::u16; }

  /// Copies `count` readings of type() from the `first` on.
  void copy(std::size_t first, std::size_t count, void* out) const;

 private:
  std::vector<std::uint8_t> narrow_;
  std::vector<std::uint16_t> wide_;  // replaces narrow_ once it is not empty
};

/// All that a Tekscan ASCII export holds.
struct TekscanExport {
  TekscanHeader header;
  CompactReadings readings;            ///< frame by frame, row by row; 0 where there is no sensel
  std::vector<std::uint64_t> numbers;  ///< of the frames, as in their lines, rising
  std::vector<double> times_s;         ///< of the frames that give one: all or none
  std::vector<std::uint8_t> mask;      ///< [rows, cols]; 0 where any frame has no sensel
};

/// Reads an export from its beginning to its end. Throws Error with the line, and the column where
/// it is one cell, of the first thing that is wrong. Memory: one or two bytes for each reading.
[[nodiscard]] TekscanExport parse_tekscan(const std::filesystem::path& path);

}  // namespace pillarfield
