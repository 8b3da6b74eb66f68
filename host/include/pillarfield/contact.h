#pragma once

#include <cstdint>
#include <vector>

namespace pillarfield {

/// The shape of the body, which fixes the pressure under it (docs/derivations/contacts.md).
enum class ContactShape : std::uint8_t {
  sphere,      ///< Hertz: p = p0 sqrt(1 − r²/a²)
  flat_punch,  ///< rigid cylinder, end on: p = P / (2 pi a sqrt(a² − r²)), singular at its edge
  cylinder,    ///< Hertz line contact along its axis: p = p0 sqrt(1 − x²/a²)
};

/// How the body moves, which fixes the shear under it.
enum class ContactMotion : std::uint8_t {
  press,         ///< no shear
  slide,         ///< gross sliding: q = mu p
  partial_slip,  ///< Cattaneo and Mindlin, Q < mu P; sphere only
  spin,          ///< gross spin about the contact's centre: q = mu p around it; not cylinder
  roll,          ///< Carter, tractive rolling with Q < mu P; cylinder only
};

/// Where the body is and how hard it presses at a time; between two, linear interpolation.
struct ContactKey {
  double time_s = 0;
  double x_mm = 0;  ///< from the patch's centre, + right
  double y_mm = 0;  ///< + up
  double load_n = 0;
};

/// One body on the skin.
struct Contact {
  ContactShape shape = ContactShape::sphere;
  ContactMotion motion = ContactMotion::press;
  /// Contact radius (sphere, punch) or half width (cylinder) at reference_load_n. It follows the
  /// load as P^(1/3) (sphere) or P^(1/2) (cylinder) and is constant for a punch.
  double contact_radius_mm = 5;
  double reference_load_n = 1;  ///< a scene's default: the heaviest load of the path
  double length_mm = 0;         ///< cylinder: length along its axis
  double friction = 0;          ///< mu
  /// Of the tangential force on the skin, counter-clockwise from +x. A cylinder's axis lies across
  /// it; a roller, being braked, rolls that way.
  double direction_deg = 0;
  double tangential_ratio = 1;   ///< Q / (mu P): partial_slip and roll, in (0, 1)
  bool clockwise = false;        ///< spin: sense of the tangential force on the skin
  std::vector<ContactKey> path;  ///< one key or more, times rising
};

}  // namespace pillarfield
