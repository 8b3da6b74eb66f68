#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "pillarfield/status.h"

namespace pillarfield::cli {

/// Counts pillars by region and by flags of their status.
struct RegionCount {
  std::array<std::uint64_t, kRegions> pillars{};
  std::uint64_t saturated = 0;
  std::uint64_t inconsistent = 0;
  std::uint64_t resolved = 0;  ///< ambiguous pillars that the estimator `contact` resolved

  void add(std::span<const std::uint8_t> status);

  [[nodiscard]] std::uint64_t of(Region region) const {
    return pillars.at(static_cast<std::size_t>(region));
  }
  [[nodiscard]] std::uint64_t all() const;
  [[nodiscard]] std::uint64_t in_contact() const { return all() - of(Region::none); }
};

/// Describes a region in a few words.
const char* meaning_of(Region region);

/// Regions of pillars in contact, in the order of tables.
inline constexpr std::array kContactRegions = {Region::one, Region::two, Region::three,
                                               Region::four, Region::opposite};

}  // namespace pillarfield::cli
