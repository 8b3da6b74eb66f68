#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace pillarfield {

/// A ratio of shear to normal force that many pillars share and almost none exceeds: they slip, and
/// it is the friction.
struct FrictionPlateau {
  double friction = 0;  ///< weighted mean ratio of the pillars that show the plateau
  double share = 0;     ///< share of all weight added that those pillars have, (0, 1]
};

/// A pillar of this share of the friction's ratio, or more, counts as lying within the plateau: the
/// lower end of the window that FrictionHistogram looks through, rounded.
inline constexpr double kWithinPlateau = 0.92;

/// Bins are the leading bits of a float, so their edges are exact: 32 ratios and 8 ceilings to an
/// octave, the ratios from 2^-5 to 2^5, the ceilings from 1 to 2^5 and all above in the last.
struct RatioBins {
  static constexpr std::uint32_t kRatios = 10 * 32;
  static constexpr std::uint32_t kCeilings = 5 * 8 + 1;
  static constexpr float kLeastRatio = 0x1p-5F;
  static constexpr float kMostRatio = 0x1p5F;

  /// Of a ratio from kLeastRatio on and below kMostRatio.
  static std::uint32_t of_ratio(float ratio) {
    return (std::bit_cast<std::uint32_t>(ratio) >> kRatioShift) - kFirstRatio;
  }
  /// Of any number.
  static std::uint32_t of_ceiling(float ceiling) {
    if (!(ceiling > 1)) return 0;
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(ceiling) >> kCeilingShift;
    return std::min(bits - kFirstCeiling, kCeilings - 1);
  }
  /// The ratio in the middle of a bin.
  static float middle_of(std::uint32_t bin) {
    const std::uint32_t half = 1u << (kRatioShift - 1);
    return std::bit_cast<float>(((bin + kFirstRatio) << kRatioShift) + half);
  }

 private:
  static constexpr int kRatioShift = 23 - 5;
  static constexpr int kCeilingShift = 23 - 3;
  static constexpr std::uint32_t kFirstRatio = (127 - 5) << 5;
  static constexpr std::uint32_t kFirstCeiling = 127 << 3;
};

/// Counts of pillars by ratio and by what ratio they could have shown. All sums are of integers, so
/// what is found depends on the pillars alone, not on their order.
///
/// Two adjacent sensels lift, and the pillar's force becomes ambiguous, where shear / normal
/// exceeds 1 / min(|cos d|, |sin d|), d being the angle between the shear and a diagonal of the
/// pillar: its ceiling, sqrt(2) or more. Pillars above it are not added, so ratios always end
/// somewhere; only where pillars of a higher ceiling end too is that the friction.
///
/// A plateau is the window of about ±9 % around a ratio such that, of the pillars whose ceiling is
/// at least 15 % above it,
/// - 8 or more, with 15 % of their weight or more, lie within,
/// - those above have at most a tenth of the weight of those within,
/// - those in as wide a window below have at most 0.4 of it: ratios that just rise towards an end
///   share none;
/// and of all such windows the one with most weight (the lowest of equal ones).
///
/// A body that sticks as a whole while its shear is everywhere the same part of its pressure, like
/// a stuck flat punch, shows the same field as one that slides; no frame can tell them apart.
class FrictionHistogram {
 public:
  static constexpr std::uint32_t kMostWeight = 4095;

  /// Adds an unambiguous pillar. `ratio` is |shear| / normal and may be anything, NaN included;
  /// ratios below 1/32, or 32 and more, are no friction. Weights above kMostWeight count as that,
  /// and 0 adds nothing. Fewer than 2^20 pillars may be added.
  void add(float ratio, std::uint32_t weight, float ceiling) {
    if (weight == 0) return;
    weight = std::min(weight, kMostWeight);
    all_weight_ += weight;
    if (ratio < RatioBins::kLeastRatio) low_weight_ += weight;
    // Also false for NaN.
    if (!(ratio >= RatioBins::kLeastRatio && ratio < RatioBins::kMostRatio)) return;
    const std::uint32_t bin = RatioBins::of_ratio(ratio);
    const std::uint32_t place = RatioBins::of_ceiling(ceiling) * RatioBins::kRatios + bin;
    Cell& cell = cells_[place];
    if (cell.pillars == 0) touched_.push_back(place);
    cell.moment += std::int64_t{weight} * static_cast<std::int32_t>(ratio * 65536);
    cell.weight += weight;
    ++cell.pillars;
  }

  void clear();

  /// Unset where no ratio is shared. Time goes with the pillars added.
  [[nodiscard]] std::optional<FrictionPlateau> plateau() const;

 private:
  struct Cell {
    std::int64_t moment = 0;  ///< of weight times ratio, cut to steps of 2^-16
    std::uint32_t weight = 0;
    std::uint32_t pillars = 0;
  };

  /// [ceiling bins, ratio bins]
  std::vector<Cell> cells_ =
      std::vector<Cell>(std::size_t{RatioBins::kCeilings} * RatioBins::kRatios);
  std::vector<std::uint32_t> touched_;  ///< the cells that are not empty
  std::int64_t all_weight_ = 0;
  std::int64_t low_weight_ = 0;                    ///< of ratios below kLeastRatio
  mutable std::vector<std::uint32_t> by_ceiling_;  ///< scratch: those of touched_, highest first
};

}  // namespace pillarfield
