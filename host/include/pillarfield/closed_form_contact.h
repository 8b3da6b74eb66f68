#pragma once

#include <cstdint>
#include <vector>

namespace pillarfield {

/// The shape of an indenter, which determines the pressure (docs/derivations/contacts.md).
enum class ContactShape : std::uint8_t {
  sphere,      ///< Hertz: p = p0 sqrt(1 − r²/a²)
  flat_punch,  ///< rigid, flat: p = P / (2 pi a sqrt(a² − r²)), singular at r = a
  cylinder,    ///< Hertz line contact: p = p0 sqrt(1 − x²/a²)
};

/// The motion of an indenter, which determines the shear.
enum class ContactMotion : std::uint8_t {
  press,         ///< no shear
  slide,         ///< gross sliding: q = mu p
  partial_slip,  ///< Cattaneo and Mindlin, Q < mu P; sphere only
  spin,          ///< gross spin about the centre: q = mu p; not for a cylinder
  roll,          ///< tractive rolling (Carter), Q < mu P; cylinder only
};

/// Position and load of an indenter at a time. Between keys they are interpolated linearly.
struct ContactKey {
  double time_s = 0;
  double x_mm = 0;  ///< from the centre of the patch, + right
  double y_mm = 0;  ///< + up
  double load_n = 0;
};

/// An indenter with a closed-form solution.
struct ClosedFormContact {
  ContactShape shape = ContactShape::sphere;
  ContactMotion motion = ContactMotion::press;
  /// Contact radius (sphere, punch) or half width (cylinder) at reference_load_n. It scales with
  /// the load as P^(1/3) (sphere) or P^(1/2) (cylinder); that of a punch is constant.
  double contact_radius_mm = 5;
  double reference_load_n = 1;  ///< default in scenes: the largest load of the path
  double length_mm = 0;         ///< cylinder: length along its axis
  double friction = 0;          ///< mu
  /// Direction of the tangential force on the skin, counter-clockwise from +x. The axis of a
  /// cylinder is perpendicular to it; a roller is braked and rolls in this direction.
  double direction_deg = 0;
  double tangential_ratio = 1;   ///< Q / (mu P) of partial_slip and roll, (0, 1)
  bool clockwise = false;        ///< spin: sense of the shear on the skin
  std::vector<ContactKey> path;  ///< at least one key, times increasing
};

}  // namespace pillarfield
