#pragma once

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
  static constexpr double kLeastRatio = 1.0 / 32;  ///< those below are no friction
  static constexpr double kMostRatio = 32;         ///< nor are those at or above
  static constexpr std::uint32_t kMostWeight = 65535;

  /// Adds an unambiguous pillar. `ratio` is |shear| / normal and may be anything, NaN included;
  /// weights above kMostWeight count as that, and 0 adds nothing.
  void add(double ratio, std::uint32_t weight, double ceiling);

  void clear();

  /// Unset where no ratio is shared. Time goes with the pillars added.
  [[nodiscard]] std::optional<FrictionPlateau> plateau() const;

 private:
  struct Cell {
    std::int64_t weight = 0;
    std::int64_t moment = 0;  ///< of weight times ratio, cut to steps of 2^-16
    std::int64_t pillars = 0;
  };

  std::vector<Cell> cells_;             ///< [ceiling bins, ratio bins], made when first needed
  std::vector<std::uint32_t> touched_;  ///< the cells that are not empty
  std::int64_t all_weight_ = 0;
  std::int64_t low_weight_ = 0;                    ///< of ratios below kLeastRatio
  mutable std::vector<std::uint32_t> by_ceiling_;  ///< scratch: those of touched_, highest first
};

}  // namespace pillarfield
