#include "viewer/style/colour_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

// Chosen far from the maps, with the largest distances within a legend and to the skin's colour,
// for normal sight and the three kinds of colour blindness.
constexpr Colour kDetermined = colour_from(0x96b478);
constexpr Colour kAmbiguous = colour_from(0xff7800);
constexpr Colour kInconsistent = colour_from(0x870f87);

struct SpecialColour {
  Colour dark, light;
  constexpr SpecialColour(Colour both) : dark(both), light(both) {}  // NOLINT: implicit
  constexpr SpecialColour(Colour on_dark, Colour on_light) : dark(on_dark), light(on_light) {}
};
constexpr std::array<SpecialColour, kSpecials> kColoursOf{{
    {colour_from(0x262a30), colour_from(0xe3e5e8)},  // idle
    colour_from(0xd21e0f),                           // saturated
    kInconsistent,
    kAmbiguous,
    colour_from(0x2dc3e1),  // from_contact
    kDetermined,            // region_1
    colour_from(0x4bd2ff),  // region_2
    kAmbiguous,             // region_3
    colour_from(0x8769f0),  // region_4
    kInconsistent,          // opposite
    kDetermined,
    {colour_from(0x50565e), colour_from(0xb4b9c0)},  // no_reading
}};

/// The colour of a status class.
Special special_of(StatusClass status) {
  constexpr std::array<Special, kStatusClasses> kSpecialOf{
      Special::determined, Special::ambiguous, Special::from_contact, Special::saturated,
      Special::inconsistent};
  return kSpecialOf.at(static_cast<std::size_t>(status));
}

bool is_fault(StatusClass status) {
  return status == StatusClass::saturated || status == StatusClass::inconsistent;
}

}  // namespace

const char* name_of(ColourMap map) {
  static constexpr std::array<const char*, kColourMaps> kNames = {"cividis", "viridis", "diverging",
                                                                  "cyclic"};
  return kNames.at(static_cast<std::size_t>(map));
}

ColourMap default_map(Scale scale) {
  if (scale == Scale::diverging) return ColourMap::diverging;
  return scale == Scale::cyclic ? ColourMap::cyclic : ColourMap::cividis;
}

Colour colour_of(Special special, Theme theme) {
  const SpecialColour& colour = kColoursOf.at(static_cast<std::size_t>(special));
  return theme == Theme::dark ? colour.dark : colour.light;
}

Colour region_colour(Region region, Theme theme) { return colour_of(special_of(region), theme); }

Special special_of(Region region) {
  constexpr std::array<Special, kRegions> kSpecialOf{Special::idle,     Special::region_1,
                                                     Special::region_2, Special::region_3,
                                                     Special::region_4, Special::opposite};
  return kSpecialOf.at(static_cast<std::size_t>(region));
}

Colour background_of(Theme theme) {
  return theme == Theme::dark ? colour_from(0x15181c) : colour_from(0xf7f8f9);
}

std::optional<Special> special_of(Quantity quantity, std::uint8_t status) {
  const StatusClass worst = status_class(status);
  if (quantity == Quantity::region && region_of(status) != Region::none) {
    return special_of(region_of(status));
  }
  if (worst == StatusClass::inconsistent && !is_pressed(status)) return Special::no_reading;
  if (is_fault(worst)) return special_of(worst);
  if (!is_pressed(status)) return Special::idle;
  if (quantity == Quantity::status) return special_of(worst);
  return std::nullopt;
}

std::size_t entry_of(float value, const Range& range, Scale scale) {
  constexpr auto kEntries = static_cast<float>(kColours);
  float place = std::floor((value - range.low) / (range.high - range.low) * kEntries);
  if (scale == Scale::cyclic) place -= kEntries * std::floor(place / kEntries);
  // True for NaN too.
  if (!(place > 0)) return 0;
  return static_cast<std::size_t>(std::min(place, kEntries - 1));
}

}  // namespace pillarfield::viewer
