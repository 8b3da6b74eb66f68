#include "viewer/source/curves.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

/// Keeps of each run of points the one with the least and the one with the largest normal force.
std::vector<CurvePoint> thinned_points(const std::deque<CurvePoint>& points, std::size_t begin,
                                       std::size_t end, std::size_t most) {
  const std::size_t run =
      std::max<std::size_t>(2 * (end - begin) / std::max<std::size_t>(most, 2), 1);
  std::vector<CurvePoint> kept;
  for (std::size_t i = begin; i < end; i += run) {
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(i);
    const auto last = points.begin() + static_cast<std::ptrdiff_t>(std::min(i + run, end));
    auto [low, high] = std::minmax_element(
        first, last, [](const auto& a, const auto& b) { return a.normal < b.normal; });
    if (high < low) std::swap(low, high);
    kept.push_back(*low);
    if (low != high) kept.push_back(*high);
  }
  return kept;
}

std::vector<CurvePoint> points_between(const std::deque<CurvePoint>& points, double from_s,
                                       double to_s, std::size_t most) {
  const auto first = std::ranges::lower_bound(points, from_s, {}, &CurvePoint::time_s);
  const auto last = std::ranges::upper_bound(points, to_s, {}, &CurvePoint::time_s);
  auto begin = static_cast<std::size_t>(first - points.begin());
  auto end = static_cast<std::size_t>(last - points.begin());
  if (begin > 0) --begin;
  if (end < points.size()) ++end;
  return begin < end ? thinned_points(points, begin, end, most) : std::vector<CurvePoint>{};
}

constexpr std::uint32_t kBlock = 8;  ///< pillars whose statuses are compared at once

/// Sums a field; moments are about the middle of the skin until finish().
class Adding {
 public:
  Adding(const ForceFieldView& forces, const Pitch& pitch_mm)
      : forces_(forces), pitch_mm_(pitch_mm), sheared_(has_pillars(forces)) {}

  [[nodiscard]] bool is_idle_block(std::uint32_t row, std::uint32_t col) const {
    std::uint64_t block = 0;
    static_assert(sizeof block == kBlock);
    std::memcpy(&block, &forces_.status[std::size_t{row} * forces_.cols + col], kBlock);
    return block == 0;
  }

  void add(std::uint32_t row, std::uint32_t col) {
    const std::size_t at = std::size_t{row} * forces_.cols + col;
    const double normal = forces_.normal[at];
    const double shear_x = sheared_ ? forces_.shear_x[at] : 0;
    const double shear_y = sheared_ ? forces_.shear_y[at] : 0;
    const bool finite = std::isfinite(normal) && std::isfinite(shear_x) && std::isfinite(shear_y);
    if ((forces_.status[at] & status::kLoaded) == 0 || !finite) return;
    const double x = (col + 0.5 - 0.5 * forces_.cols) * pitch_mm_.col_mm;
    const double y = (0.5 * forces_.rows - row - 0.5) * pitch_mm_.row_mm;
    normal_ += normal;
    first_x_ += normal * x;
    first_y_ += normal * y;
    shear_x_ += shear_x;
    shear_y_ += shear_y;
    turn_ += x * shear_y - y * shear_x;
  }

  [[nodiscard]] CurvePoint finish(const ShownField& field) const {
    const bool loaded = normal_ > 0;
    const double unknown = std::numeric_limits<double>::quiet_NaN();
    const double centre_x = loaded ? first_x_ / normal_ : unknown;
    const double centre_y = loaded ? first_y_ / normal_ : unknown;
    const auto narrow = [](double value) { return static_cast<float>(value); };
    return {.time_s = field.time_s,
            .index = field.index,
            .shear_x = narrow(shear_x_),
            .shear_y = narrow(shear_y_),
            .normal = narrow(normal_),
            .torque = narrow(turn_ - (centre_x * shear_y_ - centre_y * shear_x_)),
            .centre_x_mm = narrow(centre_x),
            .centre_y_mm = narrow(centre_y)};
  }

 private:
  const ForceFieldView& forces_;
  Pitch pitch_mm_;
  bool sheared_;
  double normal_ = 0, shear_x_ = 0, shear_y_ = 0;  ///< N
  double first_x_ = 0, first_y_ = 0;               ///< first moments of the normal force, N mm
  double turn_ = 0;                                ///< moment of the shear, N mm
};

}  // namespace

CurvePoint curve_point(const ShownField& field, const Pitch& element_pitch_mm) {
  Adding adding(field.forces, element_pitch_mm);
  const std::uint32_t cols = field.forces.cols;
  for (std::uint32_t row = 0; row < field.forces.rows; ++row) {
    for (std::uint32_t col = 0; col < cols;) {
      if (col + kBlock <= cols && adding.is_idle_block(row, col)) {
        col += kBlock;
      } else {
        adding.add(row, col++);
      }
    }
  }
  return adding.finish(field);
}

Curves::Curves(const Pitch& element_pitch_mm, std::size_t most_points)
    : pitch_mm_(element_pitch_mm), most_points_(std::max<std::size_t>(most_points, 1)) {}

void Curves::add(const CurvePoint& point) {
  const std::scoped_lock lock(mutex_);
  if (!points_.empty() && point.index <= points_.back().index) return;
  if (points_.size() == most_points_) points_.pop_front();
  points_.push_back(point);
}

std::uint64_t Curves::next() const {
  const std::scoped_lock lock(mutex_);
  return points_.empty() ? 0 : points_.back().index + 1;
}

std::pair<double, double> Curves::time_span() const {
  const std::scoped_lock lock(mutex_);
  if (points_.empty()) return {0, 0};
  return {points_.front().time_s, points_.back().time_s};
}

std::vector<CurvePoint> Curves::between(double from_s, double to_s, std::size_t most) const {
  const std::scoped_lock lock(mutex_);
  return points_between(points_, from_s, to_s, most);
}

}  // namespace pillarfield::viewer
