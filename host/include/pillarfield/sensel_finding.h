#pragma once

#include <cstdint>
#include <vector>

namespace pillarfield {

/// What is wrong, or may be wrong, with a sensel.
enum class SenselFault : std::uint8_t {
  not_a_number,  ///< most of its readings are no number
  saturated,     ///< at full scale where its fellows are not
  stuck,         ///< its reading does not move, and lies where it should not
  noisy,         ///< it varies far more than its fellows do
  silent,        ///< it does not answer where its fellows do
  unequal,       ///< it answers far less or far more than its fellows
  undecided,     ///< another sensel of its pillar is in doubt too, so parity cannot tell
};

/// "not a number", "saturated", ...
[[nodiscard]] const char* name_of(SenselFault fault);

/// A sensel that a step of a calibration found to be at fault, or suspects.
struct SenselFinding {
  std::uint32_t row = 0;
  std::uint32_t col = 0;
  SenselFault fault = SenselFault::stuck;
  bool masked = false;     ///< counts as missing from now on; not so where it is only suspected
  double mean_counts = 0;  ///< of its raw readings
};

}  // namespace pillarfield
