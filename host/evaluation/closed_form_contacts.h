#pragma once

#include <cstdint>
#include <vector>

#include "pillarfield/force_field.h"

/// Contacts of closed form: what each pillar bears.
///
/// Lengths in the frame of a body are in radii of its contact, on the skin in pillar pitches;
/// forces are in counts, k times newtons. Tractions are integrated over each pillar's square cell.
namespace pillarfield::contact_study {

/// What presses, by its pressure p, r from the centre in radii. All but the wavy body and the two
/// spheres are solutions of contact mechanics.
enum class Shape : std::uint8_t {
  sphere,          ///< √(1 − r²)
  ellipse,         ///< √(1 − x² − (y/aspect)²)
  paraboloid,      ///< 1 − r²
  two_spheres,     ///< of 1 and `second` radii; the root of the sum of both squares
  merged_spheres,  ///< the same, but the larger of both where they overlap
  wavy,            ///< √(1 − r²) · (1 + ripple · cos(waves x) · cos(waves y))
  cylinder,        ///< √(1 − x²) for |y| < aspect
  cone,            ///< acosh(1/r)
  truncated_cone,  ///< acosh(1/r), less acosh(second/r) within the tip's radius, `second`
  punch,           ///< 1/√(1 − r²), at most 100
  rounded_punch,  ///< √(1 − r²), less √(second² − r²) within the flat's radius, `second`
};

/// What the behaviour of a pressure is at the contact's edge and centre.
enum class Family : std::uint8_t { rounded, cone, punch };

enum class Motion : std::uint8_t {
  press,         ///< no shear
  partial_slip,  ///< dragged, the core sticks: friction times p less the pressure of a smaller
                 ///< contact (Cattaneo, Mindlin, Jäger)
  slide,         ///< friction times p, in one direction
  spin,          ///< slides all over, around its centre
  turn,          ///< slides all over, around a pivot off its centre
  partial_turn,  ///< as much shear as in partial slip, in the directions of a turn
  roll,          ///< along its own x: the part that touches the leading edge sticks, strip by strip
                 ///< (Carter; Haines and Ollerton)
};

[[nodiscard]] const char* name_of(Shape shape);
[[nodiscard]] const char* name_of(Motion motion);
[[nodiscard]] const char* name_of(Family family);
[[nodiscard]] Family family_of(Shape shape);
/// Whether every pillar slips.
[[nodiscard]] bool slips(Motion motion);

struct Body {
  Shape shape = Shape::sphere;
  double radius = 30;  ///< pitches
  double second = 0;   ///< of two spheres, truncated cone and rounded punch, radii
  double aspect = 1;   ///< of ellipse and cylinder; of two spheres, their distance over the sum of
                       ///< their radii
  double waves = 0;    ///< of the wavy body: radians per radius
  double ripple = 0;   ///< and the height of its waves
  double angle_deg = 0;  ///< by which it is turned, counter-clockwise
  double x = 0;          ///< of its centre, off a corner of four pillars, pitches
  double y = 0;          ///< the same, up
};

struct Drive {
  Motion motion = Motion::press;
  double direction_deg = 0;  ///< of the shear on the skin: partial slip, slide
  double load_ratio = 1;     ///< of partial slip and roll: the drag over what friction can bear
  double pivot_x = 0;        ///< of a turn, radii from the centre
  double pivot_y = 0;
};

struct StudyContact {
  Body body;
  Drive drive;
  double peak_counts = 100;  ///< the largest normal force of a pillar
};

struct Traction {
  double x = 0;
  double y = 0;
  double pressure = 0;
};

/// The pressure of a body's contact when it was `size` times as large, 0..1, at a point of its
/// frame. Zero outside. For the flat punch, whose contact does not grow, it is a made-up stuck core
/// where size is below 1.
[[nodiscard]] double pressure_at(const Body& body, double x, double y, double size = 1);

/// Size of the stuck core at a load ratio.
[[nodiscard]] double stuck_size(const Body& body, double load_ratio);

/// The tractions at a point of the body's frame for friction 1, their directions those of the skin.
[[nodiscard]] Traction traction_at(const StudyContact& contact, double x, double y);

/// What each pillar bears at friction 1, row by row from the top left; the skin is as large as the
/// contact and four pillars all round.
struct PillarLoads {
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::vector<double> shear_x;  ///< counts, for friction 1: shear is in proportion to it
  std::vector<double> shear_y;
  std::vector<double> normal;      ///< counts
  double counts_per_pressure = 1;  ///< by which pressure_at was multiplied
};

/// Gauss and Legendre's rule, 4 x 4 points, on quarters of cells, of quarters and so on, until
/// quartering changes nothing; 4096 points and more where an edge crosses. Some 20 ms for 60
/// pillars across.
[[nodiscard]] PillarLoads loads_of(const StudyContact& contact);

/// The forces at a friction, N.
[[nodiscard]] ForceField truth_of(const PillarLoads& loads, double friction,
                                  double counts_per_newton);

}  // namespace pillarfield::contact_study
