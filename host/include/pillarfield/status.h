#pragma once

#include <cstdint>

/// The bits of a pillar's status byte: which of its readings are usable, and how far its force can
/// be relied on.
namespace pillarfield::status {

inline constexpr std::uint8_t kSensel1 = 1;        ///< upper right sensel is usable
inline constexpr std::uint8_t kSensel2 = 2;        ///< upper left
inline constexpr std::uint8_t kSensel3 = 4;        ///< lower left
inline constexpr std::uint8_t kSensel4 = 8;        ///< lower right
inline constexpr std::uint8_t kUsable = 15;        ///< mask of the four
inline constexpr std::uint8_t kAmbiguous = 16;     ///< the readings leave a segment of forces open,
                                                   ///< or whether the region is 1 or 2
inline constexpr std::uint8_t kSaturated = 32;     ///< a sensel is at full scale
inline constexpr std::uint8_t kInconsistent = 64;  ///< a sensel is missing, or readings contradict
inline constexpr std::uint8_t kFromNeighbours = 128;  ///< resolved by the friction of its contact

}  // namespace pillarfield::status

namespace pillarfield {

/// The regions of the paper, by the number of usable readings (its Figure 3).
enum class Region : std::uint8_t {
  none,      ///< nothing usable: no contact
  one,       ///< four usable
  two,       ///< three usable
  three,     ///< two adjacent usable: a segment is left open
  four,      ///< one usable: nearly pure shear, or a reading near the threshold
  opposite,  ///< only two opposite usable: impossible in the model, a fault
};
inline constexpr int kRegions = 6;

/// The region of a status byte, from its usable bits.
[[nodiscard]] Region region_of(std::uint8_t status);

/// "none", "1", "2", "3", "4" or "opposite".
[[nodiscard]] const char* name_of(Region region);

}  // namespace pillarfield
