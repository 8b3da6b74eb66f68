#include "pillarfield/status.h"

#include <array>

namespace pillarfield {

Region region_of(std::uint8_t status) {
  using enum Region;
  static constexpr std::array<Region, 16> kRegionOf = {none,  four, four, three, four,     opposite,
                                                       three, two,  four, three, opposite, two,
                                                       three, two,  two,  one};
  return kRegionOf[status & status::kUsable];
}

const char* name_of(Region region) {
  switch (region) {
    case Region::none:
      return "none";
    case Region::one:
      return "1";
    case Region::two:
      return "2";
    case Region::three:
      return "3";
    case Region::four:
      return "4";
    case Region::opposite:
      break;
  }
  return "opposite";
}

}  // namespace pillarfield
