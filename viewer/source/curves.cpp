#include "viewer/source/curves.h"

#include <algorithm>

namespace pillarfield::viewer {
namespace {

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
  const SelectionSums sums = sums_over(field, rect, element_pitch_mm);
  const auto narrow = [](double value) { return static_cast<float>(value); };
  return {.time_s = field.time_s,
          .index = field.index,
          .shear_x = narrow(sums.shear_x),
          .shear_y = narrow(sums.shear_y),
          .normal = narrow(sums.normal),
          .torque = narrow(sums.moment_z),
          .centre_x_mm = narrow(sums.centre_x_mm),
          .centre_y_mm = narrow(sums.centre_y_mm)};
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

void Curves::append(Points& points, const CurvePoint& point) const {
  if (!points.empty() && point.index <= points.back().index) return;
  if (points.size() == most_points_) points.pop_front();
  points.push_back(point);
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
