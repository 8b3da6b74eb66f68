#include "simulation/indenter/indenter_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulation/indenter/height_map.h"

namespace pillarfield {
namespace {

constexpr double kNoIndenter = std::numeric_limits<double>::infinity();

/// Rise of an arc of `radius` at the distance `along` from its flat tangent point.
double arc_height(double along, double radius) {
  if (along <= 0) return 0;
  if (along > radius) return kNoIndenter;
  // Not radius − √(radius² − along²), which loses its digits.
  return along * along / (radius + std::sqrt(radius * radius - along * along));
}

class EllipsoidRelief final : public Relief {
 public:
  explicit EllipsoidRelief(const std::array<double, 3>& radii_mm) : radii_(radii_mm) {}

  [[nodiscard]] double height_mm(double x_mm, double y_mm) const override {
    const double u = x_mm / radii_[0];
    const double v = y_mm / radii_[1];
    const double square = u * u + v * v;
    return square > 1 ? kNoIndenter : radii_[2] * square / (1 + std::sqrt(1 - square));
  }
  [[nodiscard]] PlaneVector reach_mm() const override { return {radii_[0], radii_[1]}; }

 private:
  std::array<double, 3> radii_;
};

class CylinderRelief final : public Relief {
 public:
  explicit CylinderRelief(const Indenter& indenter)
      : radius_(indenter.radius_mm),
        half_length_(indenter.length_mm / 2),
        edge_(indenter.edge_radius_mm) {}

  [[nodiscard]] double height_mm(double x_mm, double y_mm) const override {
    const double along = std::abs(x_mm);
    if (along > half_length_) return kNoIndenter;
    return arc_height(std::abs(y_mm), radius_) + arc_height(along - (half_length_ - edge_), edge_);
  }
  [[nodiscard]] PlaneVector reach_mm() const override { return {half_length_, radius_}; }

 private:
  double radius_;
  double half_length_;
  double edge_;
};

class PunchRelief final : public Relief {
 public:
  explicit PunchRelief(const Indenter& indenter)
      : radius_(indenter.radius_mm), edge_(indenter.edge_radius_mm) {}

  [[nodiscard]] double height_mm(double x_mm, double y_mm) const override {
    const double r = std::hypot(x_mm, y_mm);
    return r > radius_ ? kNoIndenter : arc_height(r - (radius_ - edge_), edge_);
  }
  [[nodiscard]] PlaneVector reach_mm() const override { return {radius_, radius_}; }

 private:
  double radius_;
  double edge_;
};

/// Bilinear between pixel centres, constant beyond the outermost centres.
class MapRelief final : public Relief {
 public:
  MapRelief(HeightMap map, const Indenter& indenter)
      : map_(std::move(map)),
        size_(indenter.height_map_size_mm),
        depth_(indenter.height_map_depth_mm) {}

  [[nodiscard]] double height_mm(double x_mm, double y_mm) const override {
    if (std::abs(x_mm) > size_[0] / 2 || std::abs(y_mm) > size_[1] / 2) return kNoIndenter;
    const Pixel col = pixel(0.5 + x_mm / size_[0], map_.cols);
    const Pixel row = pixel(0.5 - y_mm / size_[1], map_.rows);
    const auto height = [&](std::size_t r) {
      const double* const left = &map_.heights[r * map_.cols + col.first];
      return std::lerp(left[0], left[1], col.fraction);
    };
    return depth_ * (1 - std::lerp(height(row.first), height(row.first + 1), row.fraction));
  }
  [[nodiscard]] PlaneVector reach_mm() const override { return {size_[0] / 2, size_[1] / 2}; }

 private:
  /// The pixel before a place and the fraction of the way to the next.
  struct Pixel {
    std::size_t first;
    double fraction;
  };

  static Pixel pixel(double share, std::size_t count) {
    const auto pixels = static_cast<double>(count);
    const double at = std::clamp(share * pixels - 0.5, 0.0, pixels - 1);
    const double first = std::min(std::floor(at), pixels - 2);
    return {static_cast<std::size_t>(first), at - first};
  }

  HeightMap map_;
  std::array<double, 2> size_;
  double depth_;
};

}  // namespace

std::unique_ptr<Relief> make_relief(const Indenter& indenter) {
  switch (indenter.shape) {
    case IndenterShape::sphere:
      return std::make_unique<EllipsoidRelief>(
          std::array<double, 3>{indenter.radius_mm, indenter.radius_mm, indenter.radius_mm});
    case IndenterShape::ellipsoid:
      return std::make_unique<EllipsoidRelief>(indenter.radii_mm);
    case IndenterShape::cylinder:
      return std::make_unique<CylinderRelief>(indenter);
    case IndenterShape::punch:
      return std::make_unique<PunchRelief>(indenter);
    case IndenterShape::height_map:
      break;
  }
  return std::make_unique<MapRelief>(read_height_map(indenter.height_map), indenter);
}

IndenterSurface::IndenterSurface(const Indenter& indenter, double pillar_pitch_mm,
                                 std::uint64_t seed, std::uint64_t number)
    : relief_(make_relief(indenter)),
      friction_(indenter.friction),
      roughness_mm_(indenter.roughness_um * 1e-3),
      friction_variation_(indenter.friction_variation) {
  if (roughness_mm_ > 0) {
    roughness_ =
        RandomField::self_affine({seed, random::Stream::roughness, number}, pillar_pitch_mm / 8,
                                 indenter.roughness_length_mm, indenter.roughness_exponent);
  }
  if (friction_variation_ > 0) {
    friction_field_ = RandomField::smooth({seed, random::Stream::friction, number},
                                          indenter.friction_variation_length_mm);
  }
}

double IndenterSurface::height_mm(double x_mm, double y_mm) const {
  const double height = relief_->height_mm(x_mm, y_mm);
  return roughness_ ? height + roughness_mm_ * roughness_->at(x_mm, y_mm) : height;
}

double IndenterSurface::friction(double x_mm, double y_mm) const {
  if (!friction_field_) return friction_;
  return friction_ * (1 + friction_variation_ * friction_field_->at(x_mm, y_mm));
}

}  // namespace pillarfield
