#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/whole_body.h"
#include "skin/vectors.h"

namespace pillarfield {

/// Sums over pillars in the frame of the patch, which add up.
struct LoadSum {
  Vector3 force_n;
  Vector3 moment_nmm;  ///< about the middle of the patch
  double normal_n = 0;
  Vector3 normal_place_nmm;  ///< sum of normal force times place

  void add(const LoadSum& other) {
    force_n = force_n + other.force_n;
    moment_nmm = moment_nmm + other.moment_nmm;
    normal_n += other.normal_n;
    normal_place_nmm = normal_place_nmm + other.normal_place_nmm;
  }
};

/// The load in the body's frame of a patch with this pose.
[[nodiscard]] BodyLoad load_of(const LoadSum& sum, const Pose& pose);

/// Adds a load in the same frame.
void add(BodyLoad& total, const BodyLoad& load);

/// The load of a patch, at the cost of what changed: sums of tiles of 4 x 4 pillars, which are the
/// pillars of a packet's block, and of rows of tiles. Sums depend on the forces alone, not on the
/// order of changes. Forces that are not finite count as zero.
class PatchLoad {
 public:
  /// `reach`: pillars around a changed block whose forces change too.
  PatchLoad(const Skin& skin, std::uint32_t reach);

  /// The forces of the pillars of these sensels may change.
  void mark(const SenselBlock& sensels);
  void mark_all();

  /// The sum over all pillars; sums of tiles that are not marked stay.
  [[nodiscard]] const LoadSum& update(const ForceFieldView& forces);

 private:
  /// Pillars of a tile.
  struct Tile {
    std::uint32_t first_row;
    std::uint32_t end_row;
    std::uint32_t first_col;
    std::uint32_t end_col;
  };

  /// Place of a pillar on a plane.
  [[nodiscard]] double x_of(std::uint32_t col) const {
    return (col - 0.5 * (pillars_.cols - 1)) * pillars_.pitch_mm;
  }
  [[nodiscard]] double y_of(std::uint32_t row) const {
    return (0.5 * (pillars_.rows - 1) - row) * pillars_.pitch_mm;
  }
  [[nodiscard]] LoadSum sum_on_plane(const ForceFieldView& forces, const Tile& tile) const;
  [[nodiscard]] LoadSum sum_on_surface(const ForceFieldView& forces, const Tile& tile) const;
  [[nodiscard]] LoadSum sum_of_finite(const ForceFieldView& forces, const Tile& tile) const;
  [[nodiscard]] LoadSum sum_of_tile(const ForceFieldView& forces, const Tile& tile) const;
  void update_row(const ForceFieldView& forces, std::uint32_t tile_row);

  PillarLayout pillars_;
  std::uint32_t reach_;
  std::uint32_t tile_rows_;
  std::uint32_t tile_cols_;
  std::vector<Pose> poses_;          ///< of each pillar; empty: a plane
  std::vector<std::uint8_t> state_;  ///< of each tile
  std::vector<std::uint8_t> marked_rows_;
  std::vector<LoadSum> tiles_;
  std::vector<LoadSum> rows_;
  LoadSum sum_;
};

}  // namespace pillarfield
