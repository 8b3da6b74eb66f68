#include "cli/region_count.h"

#include <numeric>

namespace pillarfield::cli {

void RegionCount::add(std::span<const std::uint8_t> status) {
  std::array<std::uint64_t, 256> histogram{};
  for (const std::uint8_t byte : status) ++histogram[byte];
  for (std::size_t byte = 0; byte < histogram.size(); ++byte) {
    const std::uint64_t count = histogram.at(byte);
    pillars.at(static_cast<std::size_t>(region_of(static_cast<std::uint8_t>(byte)))) += count;
    if ((byte & status::kSaturated) != 0) saturated += count;
    if ((byte & status::kInconsistent) != 0) inconsistent += count;
    if ((byte & status::kFromNeighbours) != 0) resolved += count;
  }
}

std::uint64_t RegionCount::all() const {
  return std::accumulate(pillars.begin(), pillars.end(), std::uint64_t{0});
}

const char* meaning_of(Region region) {
  switch (region) {
    case Region::none:
      return "no sensel usable: no contact";
    case Region::one:
      return "four sensels usable: force determined, parity tested";
    case Region::two:
      return "three usable: force determined";
    case Region::three:
      return "two adjacent usable: force ambiguous";
    case Region::four:
      return "one usable: force along the skin";
    case Region::opposite:
      break;
  }
  return "two opposite usable: a fault";
}

}  // namespace pillarfield::cli
