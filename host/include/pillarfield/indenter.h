#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace pillarfield {

/// The shape of a rigid indenter, in its own frame: x and y along the skin, the origin on the path,
/// the lowest point touching first.
enum class IndenterShape : std::uint8_t {
  sphere,      ///< radius_mm
  ellipsoid,   ///< radii_mm along x, y and the skin's normal
  cylinder,    ///< along x: radius_mm, length_mm, ends rounded by edge_radius_mm
  punch,       ///< a flat round face: radius_mm, edge rounded by edge_radius_mm
  height_map,  ///< a relief from a picture or an array
};

/// Position, rotation and load of an indenter at a time. Between keys they are interpolated
/// linearly.
struct IndenterKey {
  double time_s = 0;
  double x_mm = 0;       ///< from the centre of the patch, + right
  double y_mm = 0;       ///< + up
  double angle_deg = 0;  ///< counter-clockwise about its origin; not reduced to 360
  double load_n = 0;     ///< pressing force; 0: no contact
};

/// A rigid indenter on the skin, which is modelled as an incompressible elastic half-space
/// (Scene::modulus_kpa). The pressure is solved after Polonsky and Keer (Wear 231, 1999), the shear
/// as Kalker's incremental problem with Coulomb friction (Three-Dimensional Elastic Indenters in
/// Rolling Contact, 1990), so it depends on the path up to a frame. Equations and checks:
/// docs/derivations/half_space.md. Ranges: docs/scenes.md.
struct Indenter {
  IndenterShape shape = IndenterShape::sphere;
  double radius_mm = 10;                          ///< sphere, cylinder, punch
  std::array<double, 3> radii_mm = {10, 10, 10};  ///< ellipsoid: half axes along x, y, normal
  double length_mm = 20;                          ///< cylinder, end to end
  double edge_radius_mm = 0;                      ///< cylinder, punch; 0: sharp

  /// A .npy file (two-dimensional, integers or floats). Row 0 is at the top (+y); the largest value
  /// touches first. The constructor of Simulator reads it.
  std::filesystem::path height_map;
  std::array<double, 2> height_map_size_mm = {20, 20};  ///< along x, y; empty beyond
  double height_map_depth_mm = 1;  ///< between its largest and its smallest value

  /// RMS of a random self-affine roughness; 0: smooth. Its power spectrum is proportional to
  /// k^(−2 − 2 roughness_exponent) from wavelengths of roughness_length_mm down to a pillar's
  /// pitch.
  double roughness_um = 0;
  double roughness_exponent = 0.8;  ///< Hurst exponent, (0, 1]
  double roughness_length_mm = 10;

  double friction = 0;  ///< Coulomb coefficient µ
  /// Relative variation over the indenter: friction lies within µ (1 ± variation).
  double friction_variation = 0;
  double friction_variation_length_mm = 5;  ///< correlation length of that

  std::uint32_t substeps = 1;     ///< steps of the solver per frame
  std::vector<IndenterKey> path;  ///< at least one key, times increasing
};

/// Most steps of an indenter from its first frame to the last in which it moves.
inline constexpr std::uint64_t kMaxIndenterSteps = 20'000;

/// Largest contact of an indenter, in pillars along each side.
inline constexpr std::uint32_t kMaxContactPillars = 128;

}  // namespace pillarfield
