#pragma once

#include <array>
#include <string_view>

#include "pillarfield/pitch.h"

namespace pillarfield {

/// A unit in which pressures are shown. HDF5 files, streams and names that end in _kpa keep kPa.
struct PressureUnit {
  std::string_view name;    ///< "mmHg"
  std::string_view suffix;  ///< of names of columns: "mmhg"
  double kpa = 1;           ///< kPa of one unit
  friend bool operator==(const PressureUnit&, const PressureUnit&) = default;
};

/// The units that pressures can be shown in, kPa first.
inline constexpr std::array<PressureUnit, 3> kPressureUnits = {
    {{"kPa", "kpa", 1}, {"psi", "psi", 6.894757293168}, {"mmHg", "mmhg", 0.133322387415}}};

/// Pressure of a newton on an element of this pitch, kPa.
[[nodiscard]] constexpr float kpa_per_newton(const Pitch& element_pitch_mm) {
  return static_cast<float>(1000 / element_pitch_mm.area_mm2());  // N/mm² is MPa.
}

}  // namespace pillarfield
