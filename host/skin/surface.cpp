#include "pillarfield/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pillarfield/error.h"
#include "skin/vectors.h"

namespace pillarfield {
namespace {

constexpr double kLeastRadiusMm = 1;
constexpr double kMostRadiusMm = 1e6;
constexpr double kMostHeightMm = 1e4;

/// A point of the sheet that is bent along one direction.
struct BentPoint {
  double along_x, along_y;  ///< unit vector of the bent direction
  double arc_mm;            ///< distance from the middle along it
  double across_mm;         ///< distance along the straight direction, 90° counter-clockwise of it
};

Pose bent(const BentPoint& at, double radius_mm) {
  const double angle = at.arc_mm / radius_mm;
  const double half_sine = std::sin(angle / 2);
  const Vector3 along = {at.along_x, at.along_y, 0};
  const Vector3 across = {-at.along_y, at.along_x, 0};
  constexpr Vector3 kUp = {0, 0, 1};
  const Vector3 tangent = std::cos(angle) * along - std::sin(angle) * kUp;
  Pose pose;
  pose.normal = std::sin(angle) * along + std::cos(angle) * kUp;
  // Not cos(angle) − 1, which cancels at a large radius.
  pose.position_mm = radius_mm * std::sin(angle) * along + at.across_mm * across -
                     2 * radius_mm * half_sine * half_sine * kUp;
  pose.tangent_x = along.x * tangent + across.x * across;
  pose.tangent_y = along.y * tangent + across.y * across;
  return pose;
}

Pose on_cylinder(const Surface& surface, double x_mm, double y_mm) {
  const double angle = (surface.axis_deg - 90) * std::numbers::pi / 180;
  const double along_x = std::cos(angle);
  const double along_y = std::sin(angle);
  return bent({along_x, along_y, along_x * x_mm + along_y * y_mm, along_x * y_mm - along_y * x_mm},
              surface.radius_mm);
}

Pose on_sphere(const Surface& surface, double x_mm, double y_mm) {
  const double arc_mm = std::hypot(x_mm, y_mm);
  if (arc_mm == 0) return bent({1, 0, 0, 0}, surface.radius_mm);
  return bent({x_mm / arc_mm, y_mm / arc_mm, arc_mm, 0}, surface.radius_mm);
}

double x_of(const ElementGrid& pillars, std::uint32_t col) {
  return (col - 0.5 * (pillars.cols - 1)) * pillars.pitch_mm.col_mm;
}

double y_of(const ElementGrid& pillars, std::uint32_t row) {
  return (0.5 * (pillars.rows - 1) - row) * pillars.pitch_mm.row_mm;
}

/// Slope by central differences, at the rim one-sided: of `count` heights, `stride` apart.
double slope(const float* heights, std::size_t stride, std::uint32_t count, std::uint32_t index,
             double pitch_mm) {
  const std::uint32_t before = index == 0 ? 0 : index - 1;
  const std::uint32_t after = std::min(index + 1, count - 1);
  if (before == after) return 0;
  const double rise = double{heights[after * stride]} - heights[before * stride];
  return rise / ((after - before) * pitch_mm);
}

Pose on_heights(const Surface& surface, const ElementGrid& pillars, std::uint32_t row,
                std::uint32_t col) {
  const float* const heights = surface.heights_mm.data();
  const double slope_x = slope(heights + std::size_t{row} * pillars.cols, 1, pillars.cols, col,
                               pillars.pitch_mm.col_mm);
  const double slope_down =
      slope(heights + col, pillars.cols, pillars.rows, row, pillars.pitch_mm.row_mm);
  Pose pose;
  pose.position_mm = {x_of(pillars, col), y_of(pillars, row),
                      heights[std::size_t{row} * pillars.cols + col]};
  pose.normal = unit({-slope_x, slope_down, 1});
  pose.tangent_x = unit({1, 0, slope_x});
  pose.tangent_y = cross(pose.normal, pose.tangent_x);
  return pose;
}

void require_range(std::string_view where, const char* name, double value, double low,
                   double high) {
  if (value >= low && value <= high) return;
  throw Error(where, fmt::format("the surface's {} is {}", name, value),
              fmt::format("it must lie in [{}, {}]", low, high));
}

void check_heights(const Surface& surface, const ElementGrid& pillars, std::string_view where) {
  if (surface.heights_mm.empty()) throw Error(where, "the surface has no heights", "give some");
  if (surface.heights_mm.size() != std::size_t{pillars.rows} * pillars.cols) {
    throw Error(where, fmt::format("the surface has {} heights", surface.heights_mm.size()),
                fmt::format("give one for each of {} x {} pillars", pillars.rows, pillars.cols));
  }
  for (const float each_mm : surface.heights_mm) {
    require_range(where, "height", each_mm, -kMostHeightMm, kMostHeightMm);
  }
}

/// Half of the longest arc that the skin covers.
double half_arc_mm(const Surface& surface, const ElementGrid& pillars) {
  const double half_width = 0.5 * pillars.cols * pillars.pitch_mm.col_mm;
  const double half_height = 0.5 * pillars.rows * pillars.pitch_mm.row_mm;
  if (surface.shape == SurfaceShape::sphere) return std::hypot(half_width, half_height);
  const double axis = surface.axis_deg * std::numbers::pi / 180;
  return half_width * std::abs(std::sin(axis)) + half_height * std::abs(std::cos(axis));
}

}  // namespace

const char* name_of(SurfaceShape shape) {
  switch (shape) {
    case SurfaceShape::plane:
      return "plane";
    case SurfaceShape::cylinder:
      return "cylinder";
    case SurfaceShape::sphere:
      return "sphere";
    case SurfaceShape::height_map:
      break;
  }
  return "height_map";
}

void check(const Surface& surface, const ElementGrid& pillars, std::string_view where) {
  if (surface.shape == SurfaceShape::height_map) return check_heights(surface, pillars, where);
  if (surface.shape == SurfaceShape::plane) return;
  require_range(where, "axis_deg", surface.axis_deg, -360, 360);
  const double radius_mm = std::abs(surface.radius_mm);
  if (!(radius_mm >= kLeastRadiusMm && radius_mm <= kMostRadiusMm)) {
    throw Error(where, fmt::format("the surface's radius_mm is {}", surface.radius_mm),
                fmt::format("its magnitude must lie in [{}, {}]", kLeastRadiusMm, kMostRadiusMm));
  }
  const bool sphere = surface.shape == SurfaceShape::sphere;
  const double turn = sphere ? std::numbers::pi / 2 : std::numbers::pi;
  const double arc_mm = half_arc_mm(surface, pillars);
  // A skin of exactly one turn is allowed whatever its rounding.
  if (arc_mm <= turn * radius_mm * (1 + 1e-9)) return;
  throw Error(where,
              fmt::format("the skin covers more than {} of radius {} mm",
                          sphere ? "half a sphere" : "a whole cylinder", surface.radius_mm),
              fmt::format("give a radius of at least {:.4g} mm", arc_mm / turn));
}

Pose pose_at(const Surface& surface, double x_mm, double y_mm) {
  if (surface.shape == SurfaceShape::cylinder) return on_cylinder(surface, x_mm, y_mm);
  if (surface.shape == SurfaceShape::sphere) return on_sphere(surface, x_mm, y_mm);
  return {{x_mm, y_mm, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

std::vector<Pose> poses_of(const Surface& surface, const ElementGrid& pillars) {
  std::vector<Pose> poses;
  poses.reserve(std::size_t{pillars.rows} * pillars.cols);
  for (std::uint32_t row = 0; row < pillars.rows; ++row) {
    for (std::uint32_t col = 0; col < pillars.cols; ++col) {
      poses.push_back(surface.shape == SurfaceShape::height_map
                          ? on_heights(surface, pillars, row, col)
                          : pose_at(surface, x_of(pillars, col), y_of(pillars, row)));
    }
  }
  return poses;
}

}  // namespace pillarfield
