#include "viewer/style/region_diagram.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pillarfield::viewer {
namespace {

constexpr double kPi = std::numbers::pi;

/// Angular position of a sensel about its pillar, rad in (-pi, pi].
double place_of(int sensel) {
  const double place = kPi / 4 * (2 * sensel - 1);
  return place > kPi ? place - 2 * kPi : place;
}

/// Equation (3); `phi_from_sensel` is phi less the sensel's angle.
double border_theta(double phi_from_sensel) {
  return std::atan2(1.0, std::max(0.0, std::cos(phi_from_sensel)));
}

std::vector<Vec2> piece_of_border(int sensel, double from, double to, int points) {
  std::vector<Vec2> piece;
  for (int i = 0; i < points; ++i) {
    const double phi = std::lerp(from, to, static_cast<double>(i) / (points - 1));
    piece.push_back({phi, border_theta(phi - place_of(sensel))});
  }
  return piece;
}

std::vector<std::vector<Vec2>> border_of(int sensel, int points) {
  const double from = place_of(sensel) - kPi / 2;
  const double to = place_of(sensel) + kPi / 2;
  // The curve spans half a turn; a quarter of it wraps around the diagram's edge.
  const int fewer = std::max(2, points / 4);
  const int more = std::max(2, points - fewer);
  if (to > kPi) {
    return {piece_of_border(sensel, -kPi, to - 2 * kPi, fewer),
            piece_of_border(sensel, from, kPi, more)};
  }
  if (from < -kPi) {
    return {piece_of_border(sensel, -kPi, to, more),
            piece_of_border(sensel, from + 2 * kPi, kPi, fewer)};
  }
  return {piece_of_border(sensel, from, to, points)};
}

}  // namespace

std::array<std::vector<std::vector<Vec2>>, 4> region_borders(int points_per_curve) {
  return {border_of(1, points_per_curve), border_of(2, points_per_curve),
          border_of(3, points_per_curve), border_of(4, points_per_curve)};
}

std::vector<Vec2> ambiguity_contour(int sensel, double reading, double next_reading, int points) {
  if (!(reading > 0 || next_reading > 0)) return {};
  // In counts, the shear along the two sensels (a quarter turn apart) is V - s and V' - s, and the
  // normal force is s, half the parity sum, limited by the third sensel. The force comes from the
  // direction opposite to the shear.
  const double middle = std::remainder(place_of(sensel) + kPi / 4 + kPi, 2 * kPi);
  const double most = std::min(reading, next_reading) / 2;
  std::vector<Vec2> contour;
  for (int i = 0; i < points; ++i) {
    const double normal = most * i / (points - 1);
    const double along = reading - normal;
    const double along_next = next_reading - normal;
    contour.push_back({middle - kPi / 4 + std::atan2(along_next, along),
                       std::atan2(std::hypot(along, along_next), normal)});
  }
  return contour;
}

}  // namespace pillarfield::viewer
