#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "viewer/style/quantity.h"

namespace pillarfield::viewer {

struct Colour {
  std::uint8_t red = 0, green = 0, blue = 0;  ///< sRGB
  friend bool operator==(const Colour&, const Colour&) = default;
};
[[nodiscard]] constexpr Colour colour_from(std::uint32_t rgb) {  ///< 0xRRGGBB
  return {static_cast<std::uint8_t>(rgb >> 16U & 255U), static_cast<std::uint8_t>(rgb >> 8U & 255U),
          static_cast<std::uint8_t>(rgb & 255U)};
}

enum class ColourMap : std::uint8_t { cividis, viridis, diverging, cyclic };
inline constexpr int kColourMaps = 4;
inline constexpr std::size_t kColours = 256;

/// 256 colours from the low end to the high one. `diverging` has its neutral colour in the middle
/// (between entries 127 and 128); `cyclic` closes: its last entry neighbours its first.
[[nodiscard]] std::span<const Colour, kColours> table_of(ColourMap map);
[[nodiscard]] const char* name_of(ColourMap map);  ///< "cividis"
[[nodiscard]] ColourMap default_map(Scale scale);  ///< classes: has none, gives cividis

/// Colours of their own, outside every map: of pillars that have no value to show, and of classes.
/// Those that one legend can hold are told apart, by colour-blind readers too, and from all entries
/// of the maps by at least 10 in CIE dE2000 (idle excepted). What means the same has one colour:
/// region 1 and sound, region 3 and ambiguous, opposite and inconsistent.
enum class Special : std::uint8_t {
  idle,
  saturated,
  inconsistent,
  ambiguous,
  from_contact,
  region_1,
  region_2,
  region_3,
  region_4,
  opposite,
  sound
};
inline constexpr int kSpecials = 11;
enum class Theme : std::uint8_t { dark, light };
[[nodiscard]] Colour colour_of(Special special, Theme theme);  ///< only idle depends on the theme
[[nodiscard]] const char* name_of(Special special);            ///< for the legend: "saturated"
[[nodiscard]] Colour background_of(Theme theme);               ///< of the picture, around the skin

/// The colour of its own that a pillar has, by its status; none where the map gives the colour of
/// its value. A fault is shown whether the pillar is pressed or not; an ambiguous pillar has a
/// value. In `region` and `status` every pillar has such a colour.
[[nodiscard]] std::optional<Special> special_of(Quantity quantity, std::uint8_t status);

/// The entry of a table that a value gets: floor((value - low) / (high - low) * 256) in single
/// precision, clamped; a cyclic one wraps. Entry 0 where that is no number. What the shader does.
[[nodiscard]] std::size_t entry_of(float value, const Range& range, Scale scale);

}  // namespace pillarfield::viewer
