#pragma once

#include <cstdint>
#include <vector>

namespace pillarfield {

/// A fault of a sensel, certain or suspected.
enum class SenselFault : std::uint8_t {
  not_a_number,  ///< most of its readings are NaN
  absent,        ///< its reading stands for "no sensel"
  saturated,     ///< at full scale, unlike the others
  stuck,         ///< its reading is constant and out of place
  noisy,         ///< it varies far more than the others
  unresponsive,  ///< it does not respond where the others do
  unequal,       ///< it responds far less or far more than the others
  unknown,       ///< a second sensel of its pillar is suspect, so parity cannot decide
};

/// "not a number", "saturated", ...
[[nodiscard]] const char* name_of(SenselFault fault);

/// A sensel that a calibration step finds faulty or suspects.
struct SenselFinding {
  std::uint32_t row = 0;
  std::uint32_t col = 0;
  SenselFault fault = SenselFault::stuck;
  bool masked = false;     ///< treated as missing from now on; false if only suspected
  double mean_counts = 0;  ///< mean of its raw readings
};

}  // namespace pillarfield
