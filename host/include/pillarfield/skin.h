#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/pitch.h"
#include "pillarfield/surface.h"

namespace pillarfield {

/// Data type of a sensel reading.
enum class SenselType : std::uint8_t { u8, u16, f32 };

/// Bytes of one reading: 1, 2 or 4.
[[nodiscard]] std::size_t size_of(SenselType type);

/// "uint8", "uint16" or "float32", as in recordings and in messages.
[[nodiscard]] const char* name_of(SenselType type);

/// Linearises sensels whose response is a power of the force: a corrected reading r > 0 becomes
/// V = reference_counts · (r / reference_counts)^exponent. A reading of reference_counts is its own
/// image.
struct PowerLaw {
  double exponent = 1;          ///< 0.2..5
  double reference_counts = 1;  ///< 1e-3..1e6
};

/// The V of a corrected reading, >= 0 counts.
[[nodiscard]] double straightened(const PowerLaw& law, double reading);

/// The structure on the sensels, which decides what an element of the force field is.
enum class SkinLayout : std::uint8_t {
  pillars,  ///< a pillar on each 2 x 2 sensels: three components of force
  sensels,  ///< nothing: each sensel is an element, which feels normal force alone
};

/// "pillars" or "sensels", as in files and options.
[[nodiscard]] const char* name_of(SkinLayout layout);

/// The layout of this name; empty for another word.
[[nodiscard]] std::optional<SkinLayout> layout_named(std::string_view name);

/// Constants of a skin that something states: a file, a sensor, a calibration, a scene or a
/// setting. The others are assumed.
struct StatedConstants {
  bool layout = false;
  bool sensel_pitch = false;
  bool counts_per_newton = false;
};

/// A patch of skin: its size, and the constants that all its sensels share.
///
/// Sensels are counted in rows from the top (+y) and in columns from the left (-x). The pillar at
/// (r, c) stands on the sensels (2r..2r+1, 2c..2c+1); a last odd row or column has no pillar. The
/// elements of the force field are the pillars, or, without pillars, the sensels.
struct Skin {
  std::uint32_t rows = 0;               ///< sensel rows, 1..65534, with pillars from 2 on
  std::uint32_t cols = 0;               ///< sensel columns, the same
  Pitch sensel_pitch_mm = 0.632455532;  ///< 250 per cm²; with pillars the same both ways
  double counts_per_newton =
      320;  ///< k of equation (2): counts a sensel reads per newton on its pillar, or on itself
  double threshold_counts = 0;              ///< a sensel is usable if its reading is above
  std::optional<double> full_scale_counts;  ///< a reading is saturated from here on
  std::optional<PowerLaw> power_law;        ///< unset: readings are proportional to force
  std::optional<Surface> surface;           ///< unset: unknown; forces stay in the skin's own axes
  SkinLayout layout = SkinLayout::pillars;
  bool falling = false;  ///< the sensor's readings fall under load, and its frames are mirrored()
  StatedConstants stated = {};  ///< set by the library; constants other than the defaults need none

  [[nodiscard]] std::uint32_t pillar_rows() const { return rows / 2; }
  [[nodiscard]] std::uint32_t pillar_cols() const { return cols / 2; }
  [[nodiscard]] std::size_t sensels() const { return std::size_t{rows} * cols; }
  [[nodiscard]] std::size_t pillars() const { return std::size_t{pillar_rows()} * pillar_cols(); }
  [[nodiscard]] double pillar_pitch_mm() const { return 2 * sensel_pitch_mm.col_mm; }

  [[nodiscard]] bool has_pillars() const { return layout == SkinLayout::pillars; }
  [[nodiscard]] std::uint32_t element_rows() const { return has_pillars() ? pillar_rows() : rows; }
  [[nodiscard]] std::uint32_t element_cols() const { return has_pillars() ? pillar_cols() : cols; }
  [[nodiscard]] std::size_t elements() const {
    return std::size_t{element_rows()} * element_cols();
  }
  [[nodiscard]] Pitch element_pitch_mm() const { return (has_pillars() ? 2 : 1) * sensel_pitch_mm; }
  [[nodiscard]] bool states_pitch() const;              ///< stated, or not the default
  [[nodiscard]] bool states_counts_per_newton() const;  ///< stated, or not the default
  [[nodiscard]] ElementGrid element_grid() const {
    return {element_rows(), element_cols(), element_pitch_mm()};
  }
};

/// Limits that keep every result within single precision.
inline constexpr std::uint32_t kMaxSensels = 65534;  ///< rows or columns of a skin
inline constexpr double kMaxThresholdFactor = 1000;  ///< of SkinCalibration
inline constexpr double kMaxCounts = 1e33;           ///< readings, threshold, full scale
inline constexpr double kMinCountsPerNewton = 1e-2;
inline constexpr double kMaxCountsPerNewton = 1e6;

/// Rows or columns of a field of forces.
[[nodiscard]] constexpr std::uint32_t most_elements(SkinLayout layout) {
  return layout == SkinLayout::pillars ? kMaxSensels / 2 : kMaxSensels;
}

/// Limits of PowerLaw.
inline constexpr double kMinExponent = 0.2;
inline constexpr double kMaxExponent = 5;
inline constexpr double kMinReferenceCounts = 1e-3;
inline constexpr double kMaxReferenceCounts = 1e6;

/// A warning about a skin of pillars whose layout nothing states; none about others. For frames
/// that meet a skin which a program made.
[[nodiscard]] std::vector<std::string> layout_warnings(const Skin& skin);

/// Throws Error, naming `where`, if a member is out of range.
void check(const Skin& skin, std::string_view where);

}  // namespace pillarfield
