#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "pillarfield/status.h"
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

/// 256 colours from low to high. The neutral colour of `diverging` lies between entries 127 and
/// 128; `cyclic` continues from the last entry to the first.
[[nodiscard]] std::span<const Colour, kColours> table_of(ColourMap map);
[[nodiscard]] const char* name_of(ColourMap map);  ///< "cividis"
[[nodiscard]] ColourMap default_map(Scale scale);  ///< cividis for classes, which use no map

/// Colours outside every map, for classes and for pillars without a value. Colours of one legend
/// differ from each other, also for colour-blind readers, and (except the quiet ones, idle and
/// no_reading) from all entries of the maps, by at least 10 in CIE dE2000. Region 1 and determined,
/// region 3 and ambiguous, opposite and inconsistent share a colour each.
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
  determined,
  no_reading  ///< a sensel is missing, and the pillar not in contact
};
inline constexpr int kSpecials = 12;
enum class Theme : std::uint8_t { dark, light };
[[nodiscard]] Colour colour_of(Special special, Theme theme);  ///< quiet ones by theme
[[nodiscard]] Special special_of(Region region);
[[nodiscard]] Colour region_colour(Region region, Theme theme);
[[nodiscard]] Colour background_of(Theme theme);  ///< around the skin

/// The special colour of a pillar; none where the map colours its value. A fault shows on idle
/// pillars too; an ambiguous pillar has a value. In `region` and `status` every pillar has one.
[[nodiscard]] std::optional<Special> special_of(Quantity quantity, std::uint8_t status);

/// Table entry of a value, as in the shader: floor((value - low) / (high - low) * 256) in single
/// precision, clamped, or wrapped for a cyclic scale; 0 for NaN.
[[nodiscard]] std::size_t entry_of(float value, const Range& range, Scale scale);

}  // namespace pillarfield::viewer
