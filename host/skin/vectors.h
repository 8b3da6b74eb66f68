#pragma once

#include <cmath>

#include "pillarfield/surface.h"

/// Arithmetic of vectors.
namespace pillarfield {

constexpr Vector3 operator+(Vector3 a, Vector3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
constexpr Vector3 operator-(Vector3 a, Vector3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
constexpr Vector3 operator*(double s, Vector3 a) { return {s * a.x, s * a.y, s * a.z}; }
constexpr Vector3 cross(Vector3 a, Vector3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
constexpr double dot(Vector3 a, Vector3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
/// A vector in the axes of a pillar, in those of its surroundings.
constexpr Vector3 rotated(const Pose& pose, Vector3 a) {
  return a.x * pose.tangent_x + a.y * pose.tangent_y + a.z * pose.normal;
}
inline double finite_or_zero(float value) { return std::isfinite(value) ? double{value} : 0.0; }
inline Vector3 unit(Vector3 a) { return 1 / std::sqrt(dot(a, a)) * a; }

}  // namespace pillarfield
