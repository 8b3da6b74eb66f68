#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/force_field.h"

/// Forces of closed-form contacts on pillars: tractions integrated over each pillar's square cell.
/// Lengths in a body's frame are in radii of its contact, on the skin in pillar pitches; forces are
/// in counts, k times newtons.
namespace pillarfield::contact_study {

/// Shape of a body, by its pressure at the distance r from the centre, in radii. `wavy` and the two
/// spheres are not solutions of contact mechanics.
enum class Shape : std::uint8_t {
  sphere,          ///< √(1 − r²)
  ellipse,         ///< √(1 − x² − (y/aspect)²)
  paraboloid,      ///< 1 − r²
  two_spheres,     ///< radii 1 and `second`; root of the sum of squared pressures
  merged_spheres,  ///< as two_spheres, with the larger of both pressures
  wavy,            ///< √(1 − r²) · (1 + ripple · cos(waves x) · cos(waves y))
  cylinder,        ///< √(1 − x²) for |y| < aspect
  cone,            ///< acosh(1/r)
  truncated_cone,  ///< acosh(1/r), less acosh(second/r) within the tip's radius, `second`
  punch,           ///< 1/√(1 − r²), at most 100
  rounded_punch,  ///< √(1 − r²), less √(second² − r²) within the flat's radius, `second`
};

/// Classes of pressure by behaviour at the edge and the centre.
enum class Family : std::uint8_t { rounded, cone, punch };

enum class Motion : std::uint8_t {
  press,         ///< no shear
  partial_slip,  ///< dragged, stick zone in the middle: µ times p less the pressure of a smaller
                 ///< contact (Cattaneo, Mindlin, Jäger)
  slide,         ///< µ times p, in one direction
  spin,          ///< full sliding around the centre
  turn,          ///< full sliding around a pivot off the centre
  partial_turn,  ///< magnitudes of partial_slip in directions of turn
  roll,          ///< along the body's x, stick zone at the leading edge, strip by strip (Carter;
                 ///< Haines and Ollerton)
};

[[nodiscard]] const char* name_of(Shape shape);
[[nodiscard]] const char* name_of(Motion motion);
[[nodiscard]] const char* name_of(Family family);
[[nodiscard]] Family family_of(Shape shape);
/// Whether the motion is full sliding.
[[nodiscard]] bool slips(Motion motion);

struct Body {
  Shape shape = Shape::sphere;
  double radius = 30;    ///< pitches
  double second = 0;     ///< second radius of two spheres, truncated cone and rounded punch
  double aspect = 1;     ///< of ellipse and cylinder; of two spheres: distance over sum of radii
  double waves = 0;      ///< wave number of `wavy`, radians per radius
  double ripple = 0;     ///< relative height of its waves
  double angle_deg = 0;  ///< rotation, counter-clockwise
  double x = 0;          ///< centre, from a corner of four pillars, pitches
  double y = 0;          ///< upwards
};

struct TangentialLoad {
  Motion motion = Motion::press;
  double direction_deg = 0;  ///< direction of the shear on the skin: partial_slip, slide
  double load_ratio = 1;     ///< Q/(µP) of partial_slip and roll
  double pivot_x = 0;        ///< pivot of a turn, radii from the centre
  double pivot_y = 0;
};

struct StudyContact {
  Body body;
  TangentialLoad tangential;
  double peak_counts = 100;  ///< the largest normal force of a pillar
};

struct Traction {
  double x = 0;
  double y = 0;
  double pressure = 0;
};

/// Pressure at a point of the body's frame when the contact had `size` times its radius, 0 to 1;
/// zero outside. A flat punch's contact does not grow: below size 1 it is an invented stick zone.
[[nodiscard]] double pressure_at(const Body& body, double x, double y, double size = 1);

/// Size of the stick zone at a load ratio.
[[nodiscard]] double stick_size(const Body& body, double load_ratio);

/// Tractions at a point of the body's frame for friction 1, components in the skin's frame.
[[nodiscard]] Traction traction_at(const StudyContact& contact, double x, double y);

/// Loads of each pillar at friction 1, row by row from the top left. The skin is the contact's
/// bounding box and four pillars on each side.
struct PillarLoads {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<double> shear_x;  ///< counts, at friction 1
  std::vector<double> shear_y;
  std::vector<double> normal;      ///< counts
  double counts_per_pressure = 1;  ///< factor on pressure_at()
};

/// Integrates by adaptive Gauss–Legendre quadrature, 4 × 4 points on recursively quartered cells,
/// at least 4096 points at an edge. About 20 ms for 60 pillars across.
[[nodiscard]] PillarLoads loads_of(const StudyContact& contact);

/// The forces at a friction coefficient, N.
[[nodiscard]] ForceField truth_of(const PillarLoads& loads, double friction,
                                  double counts_per_newton);

}  // namespace pillarfield::contact_study
