#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pillarfield {

/// The rigid surface that touches the skin, in the body's own frame: x and y along the skin, its
/// origin where the path puts the body, the lowest point touching first.
enum class BodyShape : std::uint8_t {
  sphere,      ///< radius_mm
  ellipsoid,   ///< radii_mm, its axes along x, y and the skin's normal
  cylinder,    ///< lies along x: radius_mm, length_mm, its ends rounded by edge_radius_mm
  punch,       ///< a round stamp on its flat end: radius_mm, its edge rounded by edge_radius_mm
  height_map,  ///< a relief read from a picture or an array
};

/// Where the body is, how it is turned and how hard it presses at a time; linear in between.
struct BodyKey {
  double time_s = 0;
  double x_mm = 0;       ///< from the patch's centre, + right
  double y_mm = 0;       ///< + up
  double angle_deg = 0;  ///< counter-clockwise about its origin; beyond 360 it turns on
  double load_n = 0;     ///< pressing force; 0: it does not touch
};

/// A rigid body on the skin, which is then an elastic half-space (Scene::modulus_kpa,
/// incompressible). What it does to each pillar is computed: pressure by Polonsky and Keer (Wear
/// 231, 1999), shear by Kalker's incremental problem with Coulomb friction (Three-Dimensional
/// Elastic Bodies in Rolling Contact, 1990), so it depends on the path up to a frame.
/// Equations and checks: docs/derivations/half_space.md. Ranges: docs/scenes.md.
struct Body {
  BodyShape shape = BodyShape::sphere;
  double radius_mm = 10;                          ///< sphere, cylinder, punch
  std::array<double, 3> radii_mm = {10, 10, 10};  ///< ellipsoid: half axes along x, y, normal
  double length_mm = 20;                          ///< cylinder: from end to end
  double edge_radius_mm = 0;                      ///< cylinder, punch; 0: a sharp edge

  /// .npy (two dimensions, whole numbers or floats) or .png (grey, 8 or 16 bits). Its first row is
  /// at the top (+y) and its largest value touches first. It is read when a Simulator is made.
  std::filesystem::path height_map;
  std::array<double, 2> height_map_size_mm = {20, 20};  ///< x, y; nothing is beyond
  double height_map_depth_mm = 1;                       ///< from its largest value to its least

  /// Root mean square of a random, self-affine roughness; 0: smooth. Its power spectrum falls as
  /// k^(−2 − 2 roughness_exponent) from wavelengths of roughness_length_mm to those of a pillar.
  double roughness_um = 0;
  double roughness_exponent = 0.8;  ///< of Hurst, (0, 1]
  double roughness_length_mm = 10;

  double friction = 0;  ///< µ of Coulomb's law
  /// Friction varies over the body between µ (1 − variation) and µ (1 + variation).
  double friction_variation = 0;
  double friction_variation_length_mm = 5;  ///< over which it does

  std::uint32_t substeps = 1;  ///< steps of the path from frame to frame
  std::vector<BodyKey> path;   ///< one key or more, times rising
};

/// Steps that a body may take, from its first frame to the last in which it moves.
inline constexpr std::uint64_t kMaxBodySteps = 20'000;

/// Pillars along each side of the largest square that a contact fits in.
inline constexpr std::uint32_t kMaxContactPillars = 128;

}  // namespace pillarfield
