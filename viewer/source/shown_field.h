#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/sensor_effects.h"

namespace pillarfield::viewer {

struct ShownContacts;

/// A field on display. Its memory stays unchanged while a copy is alive and returns to the producer
/// with the last copy.
struct ShownField {
  ForceFieldView forces;
  FrameView raw;                            ///< its readings; no data for a source without
  double time_s = 0;                        ///< time of the frame in its source
  std::uint64_t index = 0;                  ///< index of the frame in its source
  std::uint64_t frames = 0;                 ///< of the source at that time; 0: not known
  std::optional<double> direct_point = {};  ///< argument of component_ends(), as the next one
  ShearCoefficient shear_coefficient = {};
  /// Whole pages with all planes of `forces`, which a graphics device may import.
  std::span<const std::byte> pages;
  std::shared_ptr<const void> keep_alive;
  std::shared_ptr<const ShownContacts> contacts = {};    ///< null while contacts are off
  std::optional<std::chrono::nanoseconds> arrived = {};  ///< from a sensor, std::steady_clock
};

}  // namespace pillarfield::viewer
