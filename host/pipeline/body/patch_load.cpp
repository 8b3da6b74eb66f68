#include "pipeline/body/patch_load.h"

#include <algorithm>
#include <cmath>

#include "skin/vectors.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kTile = PILLARFIELD_BLOCK_SIDE / 2;  ///< pillars

std::uint32_t tiles_along(std::uint32_t pillars) { return (pillars + kTile - 1) / kTile; }

constexpr std::uint8_t kIdleTile = 0;  ///< without force
constexpr std::uint8_t kLoadedTile = 1;
constexpr std::uint8_t kMarkedTile = 2;  ///< to be summed again

bool is_zero(const Vector3& vector) { return vector.x == 0 && vector.y == 0 && vector.z == 0; }

bool is_zero(const LoadSum& sum) {
  return sum.normal_n == 0 && is_zero(sum.force_n) && is_zero(sum.moment_nmm) &&
         is_zero(sum.normal_place_nmm);
}

/// A force at a point of a surface.
LoadSum load_at(const Pose& pose, double shear_x, double shear_y, double normal) {
  const Vector3 force_n = rotated(pose, {shear_x, shear_y, -normal});
  return {force_n, cross(pose.position_mm, force_n), normal, normal * pose.position_mm};
}

}  // namespace

BodyLoad load_of(const LoadSum& sum, const Pose& pose) {
  BodyLoad load;
  load.wrench.force_n = rotated(pose, sum.force_n);
  load.wrench.moment_nmm =
      rotated(pose, sum.moment_nmm) + cross(pose.position_mm, load.wrench.force_n);
  load.normal_n = sum.normal_n;
  if (sum.normal_n > 0) {
    load.centre_of_pressure_mm =
        pose.position_mm + 1 / sum.normal_n * rotated(pose, sum.normal_place_nmm);
  }
  return load;
}

void add(BodyLoad& total, const BodyLoad& load) {
  total.wrench.force_n = total.wrench.force_n + load.wrench.force_n;
  total.wrench.moment_nmm = total.wrench.moment_nmm + load.wrench.moment_nmm;
  const auto moment_of = [](const BodyLoad& of) {
    return of.normal_n * of.centre_of_pressure_mm.value_or(Vector3{});
  };
  const Vector3 place_nmm = moment_of(total) + moment_of(load);
  total.normal_n += load.normal_n;
  total.centre_of_pressure_mm.reset();
  if (total.normal_n > 0) total.centre_of_pressure_mm = 1 / total.normal_n * place_nmm;
}

PatchLoad::PatchLoad(const Skin& skin, std::uint32_t reach)
    : pillars_(skin.pillar_layout()),
      reach_(reach),
      tile_rows_(tiles_along(pillars_.rows)),
      tile_cols_(tiles_along(pillars_.cols)),
      state_(std::size_t{tile_rows_} * tile_cols_, kMarkedTile),
      marked_rows_(tile_rows_, 1),
      tiles_(state_.size()),
      rows_(tile_rows_) {
  if (skin.surface && skin.surface->shape != SurfaceShape::plane) {
    poses_ = poses_of(*skin.surface, pillars_);
  }
}

void PatchLoad::mark(const SenselBlock& sensels) {
  if (sensels.rows == 0 || sensels.cols == 0) return;
  const auto first = [this](std::uint32_t sensel) {
    return (std::max(sensel / 2, reach_) - reach_) / kTile;
  };
  const auto last = [this](std::uint32_t sensel, std::uint32_t tiles) {
    return std::min((sensel / 2 + reach_) / kTile, tiles - 1);
  };
  const std::uint32_t last_row = last(sensels.first_row + sensels.rows - 1, tile_rows_);
  const std::uint32_t last_col = last(sensels.first_col + sensels.cols - 1, tile_cols_);
  for (std::uint32_t row = first(sensels.first_row); row <= last_row; ++row) {
    marked_rows_[row] = 1;
    for (std::uint32_t col = first(sensels.first_col); col <= last_col; ++col) {
      state_[std::size_t{row} * tile_cols_ + col] = kMarkedTile;
    }
  }
}

void PatchLoad::mark_all() {
  std::ranges::fill(state_, kMarkedTile);
  std::ranges::fill(marked_rows_, std::uint8_t{1});
}

LoadSum PatchLoad::sum_on_plane(const ForceFieldView& forces, const Tile& tile) const {
  // A row first: its y is one. Places count in pitches.
  struct Sums {
    double normal = 0;
    double shear_x = 0;
    double shear_y = 0;
    double normal_x = 0;
    double shear_y_x = 0;
  };
  LoadSum sum;
  const double first_x = tile.first_col - 0.5 * (pillars_.cols - 1);
  const double pitch = pillars_.pitch_mm;
  for (std::uint32_t row = tile.first_row; row < tile.end_row; ++row) {
    const std::size_t first = std::size_t{row} * pillars_.cols;
    Sums sums;
    for (std::uint32_t col = tile.first_col; col < tile.end_col; ++col) {
      const double x = first_x + (col - tile.first_col);
      const double normal = forces.normal[first + col];
      const double shear_y = forces.shear_y[first + col];
      sums.normal += normal;
      sums.shear_x += forces.shear_x[first + col];
      sums.shear_y += shear_y;
      sums.normal_x += x * normal;
      sums.shear_y_x += x * shear_y;
    }
    const double y_mm = y_of(row);
    sum.add(
        {{sums.shear_x, sums.shear_y, -sums.normal},
         {-y_mm * sums.normal, pitch * sums.normal_x, pitch * sums.shear_y_x - y_mm * sums.shear_x},
         sums.normal,
         {pitch * sums.normal_x, y_mm * sums.normal, 0}});
  }
  return sum;
}

LoadSum PatchLoad::sum_on_surface(const ForceFieldView& forces, const Tile& tile) const {
  LoadSum sum;
  for (std::uint32_t row = tile.first_row; row < tile.end_row; ++row) {
    for (std::uint32_t col = tile.first_col; col < tile.end_col; ++col) {
      const std::size_t at = std::size_t{row} * pillars_.cols + col;
      sum.add(load_at(poses_[at], forces.shear_x[at], forces.shear_y[at], forces.normal[at]));
    }
  }
  return sum;
}

/// Where a force is not finite.
LoadSum PatchLoad::sum_of_finite(const ForceFieldView& forces, const Tile& tile) const {
  LoadSum sum;
  for (std::uint32_t row = tile.first_row; row < tile.end_row; ++row) {
    for (std::uint32_t col = tile.first_col; col < tile.end_col; ++col) {
      const std::size_t at = std::size_t{row} * pillars_.cols + col;
      const Pose flat = {{x_of(col), y_of(row), 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
      sum.add(load_at(poses_.empty() ? flat : poses_[at], finite_or_zero(forces.shear_x[at]),
                      finite_or_zero(forces.shear_y[at]), finite_or_zero(forces.normal[at])));
    }
  }
  return sum;
}

LoadSum PatchLoad::sum_of_tile(const ForceFieldView& forces, const Tile& tile) const {
  const LoadSum sum = poses_.empty() ? sum_on_plane(forces, tile) : sum_on_surface(forces, tile);
  const bool finite = std::isfinite(sum.normal_n + sum.force_n.x + sum.force_n.y + sum.force_n.z);
  return finite ? sum : sum_of_finite(forces, tile);
}

void PatchLoad::update_row(const ForceFieldView& forces, std::uint32_t tile_row) {
  LoadSum row;
  for (std::uint32_t col = 0; col < tile_cols_; ++col) {
    const std::size_t tile = std::size_t{tile_row} * tile_cols_ + col;
    if (state_[tile] == kIdleTile) continue;
    if (state_[tile] == kMarkedTile) {
      const std::uint32_t first_row = tile_row * kTile;
      const std::uint32_t first_col = col * kTile;
      tiles_[tile] = sum_of_tile(forces, {first_row, std::min(first_row + kTile, pillars_.rows),
                                          first_col, std::min(first_col + kTile, pillars_.cols)});
    }
    state_[tile] = is_zero(tiles_[tile]) ? kIdleTile : kLoadedTile;
    row.add(tiles_[tile]);
  }
  rows_[tile_row] = row;
}

const LoadSum& PatchLoad::update(const ForceFieldView& forces) {
  sum_ = {};
  for (std::uint32_t row = 0; row < tile_rows_; ++row) {
    if (marked_rows_[row] != 0) update_row(forces, row);
    marked_rows_[row] = 0;
    sum_.add(rows_[row]);
  }
  return sum_;
}

}  // namespace pillarfield
