#pragma once

#include <cstdint>

/// The bits of a pillar's status byte: its usable readings and the reliability of its force.
namespace pillarfield::status {

inline constexpr std::uint8_t kSensel1 = 1;        ///< upper right sensel is usable
inline constexpr std::uint8_t kSensel2 = 2;        ///< upper left
inline constexpr std::uint8_t kSensel3 = 4;        ///< lower left
inline constexpr std::uint8_t kSensel4 = 8;        ///< lower right
inline constexpr std::uint8_t kUsable = 15;        ///< mask of the four
inline constexpr std::uint8_t kAmbiguous = 16;     ///< the readings allow a segment of forces,
                                                   ///< or both regions 1 and 2
inline constexpr std::uint8_t kSaturated = 32;     ///< a sensel is at full scale
inline constexpr std::uint8_t kInconsistent = 64;  ///< a sensel is missing (an absent one: and the
                                                   ///< pillar in contact), or readings contradict
inline constexpr std::uint8_t kFromNeighbours = 128;  ///< resolved by the friction of its contact

/// A pillar with one of these is loaded: its contact counts it.
inline constexpr std::uint8_t kLoaded = kUsable | kSaturated;

}  // namespace pillarfield::status

namespace pillarfield {

/// The regions of the paper, by the number of usable readings (its Figure 3).
enum class Region : std::uint8_t {
  none,      ///< nothing usable: no contact
  one,       ///< four usable
  two,       ///< three usable
  three,     ///< two adjacent usable: the force lies on a segment
  four,      ///< one usable: nearly pure shear, or a reading near the threshold
  opposite,  ///< only two opposite usable: impossible in the model, a fault
};
inline constexpr int kRegions = 6;

/// The region of a status byte, from its usable bits.
[[nodiscard]] Region region_of(std::uint8_t status);

/// True if the readings of a pillar determine its force but for noise: three or four sensels are
/// usable, none is saturated. If noise leaves it open whether the fourth sensel presses, the pillar
/// has `status::kAmbiguous` too.
[[nodiscard]] constexpr bool is_determined(std::uint8_t status) {
  const int unusable = ~status & status::kUsable;
  return ((unusable & (unusable - 1)) | (status & status::kSaturated)) == 0;
}

/// True if the readings of a pillar restrict its force to a segment (docs/derivations/segment.md),
/// resolved or not: two adjacent sensels usable, the others inactive. Other pillars may also have
/// `status::kAmbiguous`.
[[nodiscard]] inline bool has_feasible_segment(std::uint8_t status) {
  return (status & status::kAmbiguous) != 0 && region_of(status) == Region::three &&
         (status & (status::kSaturated | status::kInconsistent)) == 0;
}

/// "none", "1", "2", "3", "4" or "opposite".
[[nodiscard]] const char* name_of(Region region);

}  // namespace pillarfield
