#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "viewer/picture/quantity.h"

namespace pillarfield::viewer {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;  ///< sRGB
  friend bool operator==(const Colour&, const Colour&) = default;
};

enum class ColourMap : std::uint8_t { cividis, viridis, diverging, cyclic };
inline constexpr int kColourMaps = 4;
inline constexpr std::size_t kColours = 256;

/// 256 colours from the low end to the high one. `diverging` has its neutral colour in the middle
/// (between entries 127 and 128); `cyclic` closes: its last entry neighbours its first.
[[nodiscard]] std::span<const Colour, kColours> table_of(ColourMap map);
[[nodiscard]] const char* name_of(ColourMap map);
[[nodiscard]] ColourMap default_map(Scale scale);  ///< classes: has none, gives cividis

/// Colours of their own, outside every map: of pillars that have no value to show, and of classes.
/// Colour-blind safe, and told apart from all entries of the maps by at least 10 in CIE dE2000
/// (idle excepted).
enum class Special : std::uint8_t {
  idle,
  saturated,
  inconsistent,
  ambiguous,
  from_neighbours,
  region_1,
  region_2,
  region_3,
  region_4,
  opposite,
  sound
};
inline constexpr int kSpecials = 11;
enum class Theme : std::uint8_t { dark, light };
[[nodiscard]] Colour colour_of(Special special, Theme theme);
[[nodiscard]] const char* name_of(Special special);  ///< for the legend: "saturated"

/// The entry of a table that a value gets: floor((value - low)/(high - low) * 256), clamped; a
/// cyclic one wraps. What the shader does.
[[nodiscard]] std::size_t entry_of(float value, const Range& range, Scale scale);

}  // namespace pillarfield::viewer
