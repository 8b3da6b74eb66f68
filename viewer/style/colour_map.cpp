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
constexpr Colour kSaturated = colour_from(0xd21e0f);
constexpr Colour kFromContact = colour_from(0x2dc3e1);
constexpr Colour kRegion2 = colour_from(0x4bd2ff);
constexpr Colour kRegion4 = colour_from(0x8769f0);

/// The colour of a status class.
Special special_of(StatusClass status) {
  switch (status) {
    case StatusClass::determined:
      return Special::determined;
    case StatusClass::ambiguous:
      return Special::ambiguous;
    case StatusClass::from_contact:
      return Special::from_contact;
    case StatusClass::saturated:
      return Special::saturated;
    case StatusClass::inconsistent:
      break;
  }
  return Special::inconsistent;
}

Special special_of(Region region) {
  switch (region) {
    case Region::none:
      return Special::idle;
    case Region::one:
      return Special::region_1;
    case Region::two:
      return Special::region_2;
    case Region::three:
      return Special::region_3;
    case Region::four:
      return Special::region_4;
    case Region::opposite:
      break;
  }
  return Special::opposite;
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
  switch (scale) {
    case Scale::diverging:
      return ColourMap::diverging;
    case Scale::cyclic:
      return ColourMap::cyclic;
    case Scale::sequential:
    case Scale::classes:
      break;
  }
  return ColourMap::cividis;
}

Colour colour_of(Special special, Theme theme) {
  switch (special) {
    case Special::idle:
      return theme == Theme::dark ? colour_from(0x262a30) : colour_from(0xe3e5e8);
    case Special::no_reading:
      return theme == Theme::dark ? colour_from(0x50565e) : colour_from(0xb4b9c0);
    case Special::saturated:
      return kSaturated;
    case Special::inconsistent:
    case Special::opposite:
      return kInconsistent;
    case Special::ambiguous:
    case Special::region_3:
      return kAmbiguous;
    case Special::from_contact:
      return kFromContact;
    case Special::region_2:
      return kRegion2;
    case Special::region_4:
      return kRegion4;
    case Special::region_1:
    case Special::determined:
      break;
  }
  return kDetermined;
}

const char* name_of(Special special) {
  static constexpr std::array<const char*, kSpecials> kNames = {
      "no contact",      "saturated",        "inconsistent", "ambiguous",
      "from neighbours", "region 1",         "region 2",     "region 3",
      "region 4",        "opposite sensels", "determined",   "no reading"};
  return kNames.at(static_cast<std::size_t>(special));
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
