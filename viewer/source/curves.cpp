#include "viewer/source/curves.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace pillarfield::viewer {
namespace {

/// Sums of forces and their first moments about the middle of the skin.
struct CurveSums {
  double x = 0, y = 0, normal = 0, first_x = 0, first_y = 0, turn = 0;

  void add(double x_n, double y_n, double normal_n, double x_mm, double y_mm) {
    if (!std::isfinite(x_n) || !std::isfinite(y_n) || !std::isfinite(normal_n)) return;
    x += x_n;
    y += y_n;
    normal += normal_n;
    first_x += normal_n * x_mm;
    first_y += normal_n * y_mm;
    turn += x_mm * y_n - y_mm * x_n;
  }
};

bool is_idle_block(const std::uint8_t* status) {
  std::uint64_t block = 0;
  std::memcpy(&block, status, sizeof block);
  return block == 0;
}

CurveSums curve_sums(const ForceFieldView& forces, const PillarRect& rect, const Pitch& pitch_mm) {
  constexpr std::uint32_t kBlock = 8;
  const bool sheared = has_pillars(forces);
  CurveSums sums;
  const std::uint32_t row_end = std::min(rect.row_end, forces.rows);
  const std::uint32_t col_end = std::min(rect.col_end, forces.cols);
  for (std::uint32_t row = rect.row_begin; row < row_end; ++row) {
    const double y_mm = (0.5 * forces.rows - row - 0.5) * pitch_mm.row_mm;
    const std::size_t first = std::size_t{row} * forces.cols;
    for (std::uint32_t col = rect.col_begin; col < col_end;) {
      if (col + kBlock <= col_end && is_idle_block(&forces.status[first + col])) {
        col += kBlock;
        continue;
      }
      const std::size_t at = first + col;
      if ((forces.status[at] & status::kUsable) != 0) {
        const float x_n = sheared ? forces.shear_x[at] : 0;
        const float y_n = sheared ? forces.shear_y[at] : 0;
        sums.add(x_n, y_n, forces.normal[at], (col + 0.5 - 0.5 * forces.cols) * pitch_mm.col_mm,
                 y_mm);
      }
      ++col;
    }
  }
  return sums;
}

std::uint64_t next_index(const std::deque<CurvePoint>& points) {
  return points.empty() ? 0 : points.back().index + 1;
}

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

}  // namespace

CurvePoint curve_point(const ShownField& field, const PillarRect& rect,
                       const Pitch& element_pitch_mm) {
  const CurveSums sums = curve_sums(field.forces, rect, element_pitch_mm);
  const bool loaded = sums.normal > 0;
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  const double centre_x = loaded ? sums.first_x / sums.normal : unknown;
  const double centre_y = loaded ? sums.first_y / sums.normal : unknown;
  const auto narrow = [](double value) { return static_cast<float>(value); };
  return {.time_s = field.time_s,
          .index = field.index,
          .shear_x = narrow(sums.x),
          .shear_y = narrow(sums.y),
          .normal = narrow(sums.normal),
          .torque = narrow(sums.turn - (centre_x * sums.y - centre_y * sums.x)),
          .centre_x_mm = narrow(centre_x),
          .centre_y_mm = narrow(centre_y)};
}

Curves::Curves(const Pitch& element_pitch_mm, std::size_t most_points)
    : pitch_mm_(element_pitch_mm), most_points_(std::max<std::size_t>(most_points, 1)) {}

void Curves::set_rects(std::span<const PillarRect> rects) {
  const std::scoped_lock lock(mutex_);
  std::vector<Curve> next;
  for (const PillarRect& rect : rects) {
    if (std::ranges::find(next, rect, &Curve::rect) != next.end()) continue;
    const auto old =
        std::ranges::find_if(curves_, [&](const Curve& curve) { return curve.rect == rect; });
    next.push_back(old == curves_.end() ? Curve{rect, {}} : std::move(*old));
  }
  curves_ = std::move(next);
}

void Curves::append(Points& points, const CurvePoint& point) {
  if (!points.empty() && point.index <= points.back().index) return;
  if (points.size() == most_points_) points.pop_front();
  points.push_back(point);
  ++version_;
}

void Curves::add(const ShownField& field) {
  const CurvePoint total =
      curve_point(field, {0, field.forces.rows, 0, field.forces.cols}, pitch_mm_);
  const std::scoped_lock lock(mutex_);
  append(total_, total);
  for (Curve& curve : curves_) append(curve.points, curve_point(field, curve.rect, pitch_mm_));
}

void Curves::add_total(const CurvePoint& total) {
  const std::scoped_lock lock(mutex_);
  append(total_, total);
}

std::uint64_t Curves::next() const {
  const std::scoped_lock lock(mutex_);
  std::uint64_t least = next_index(total_);
  for (const Curve& curve : curves_) least = std::min(least, next_index(curve.points));
  return least;
}

bool Curves::wants_total_alone(std::uint64_t index) const {
  const std::scoped_lock lock(mutex_);
  return next_index(total_) <= index && std::ranges::all_of(curves_, [&](const Curve& curve) {
           return next_index(curve.points) > index;
         });
}

void Curves::clear() {
  const std::scoped_lock lock(mutex_);
  total_.clear();
  for (Curve& curve : curves_) curve.points.clear();
  ++version_;
}

std::uint64_t Curves::version() const {
  const std::scoped_lock lock(mutex_);
  return version_;
}

std::pair<double, double> Curves::time_span() const {
  const std::scoped_lock lock(mutex_);
  if (total_.empty()) return {0, 0};
  return {total_.front().time_s, total_.back().time_s};
}

std::vector<CurvePoint> Curves::total(double from_s, double to_s, std::size_t most) const {
  const std::scoped_lock lock(mutex_);
  return points_between(total_, from_s, to_s, most);
}

std::vector<CurvePoint> Curves::of(const PillarRect& rect, double from_s, double to_s,
                                   std::size_t most) const {
  const std::scoped_lock lock(mutex_);
  const auto found =
      std::ranges::find_if(curves_, [&](const Curve& curve) { return curve.rect == rect; });
  if (found == curves_.end()) return {};
  return points_between(found->points, from_s, to_s, most);
}

}  // namespace pillarfield::viewer
