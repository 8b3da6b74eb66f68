#pragma once

#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// The result of MemoryFinder.
struct MemoryResult {
  SkinCalibration calibration;
  bool found = false;           ///< whether the memory explains the readings significantly better
  SenselMemory memory;          ///< fitted, whether found or not
  double hysteresis = 0;        ///< width of its loop at half the range, as a fraction of the range
  double creep_per_decade = 0;  ///< its rise from a tenth of the longest recording to all of it
  double range_counts = 0;      ///< largest V of the experiment
  double dead_zone_counts = 0;  ///< common to all sensels
  bool curved = false;          ///< whether the response curve is fitted again
  /// RMS of the reading of the whole skin minus that of the model, as a fraction of the range:
  /// without memory and with it.
  double residual_before = 0;
  double residual_after = 0;
};

/// Finds hysteresis and creep from uniform pressure that rises, rests and falls in a known way
/// (docs/calibration.md). Memory: 32 bytes a frame.
class MemoryFinder {
 public:
  /// Throws Error if the calibration is of another skin or has no tare or counts per newton.
  MemoryFinder(const Skin& skin, const SkinCalibration& calibration);

  /// Begins a recording, before which the skin has rested.
  void begin() { begins_ = true; }

  /// Adds a frame of the skin's size under a pressure, kPa. Throws Error if less than half of the
  /// sensels can be read, or the time does not rise.
  void add(const FrameView& frame, double time_s, double pressure_kpa);

  /// The memory so far. If found, it replaces that of the calibration, the dead zones become a
  /// common one, and k or the response curve follow, since `equilibrate` took a part of the memory
  /// for sensitivity. Throws Error if the frames are too few or the pressure does not change.
  [[nodiscard]] MemoryResult result() const;

  /// The mean reading and the load of a frame.
  struct Sample {
    double interval_s;   ///< since the frame before; 0 in the first one of a recording
    double load_counts;  ///< k · pressure · area of a pillar · pillar_sum()
    double reading;      ///< after tare, gain, curve and neighbours
  };

 private:
  Skin skin_;
  SkinCalibration calibration_;
  bool begins_ = true;
  double time_s_ = 0;
  std::vector<Sample> samples_;
};

}  // namespace pillarfield
