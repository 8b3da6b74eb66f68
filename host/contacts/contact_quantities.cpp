#include "pillarfield/contact_quantities.h"

namespace pillarfield {

const char* name_of(SlipState state) {
  switch (state) {
    case SlipState::unknown:
      return "unknown";
    case SlipState::sticking:
      return "sticking";
    case SlipState::partial:
      return "partial";
    case SlipState::sliding:
      break;
  }
  return "sliding";
}

const char* name_of(FrictionSource source) {
  switch (source) {
    case FrictionSource::prior:
      return "prior";
    case FrictionSource::given:
      return "given";
    case FrictionSource::observed:
      return "observed";
    case FrictionSource::carried_over:
      return "carried_over";
    case FrictionSource::at_least:
      break;
  }
  return "at_least";
}

Moment moment_about(const PatchPlace& point, const ContactQuantities& contact) {
  const double x = contact.centre_of_pressure.x_mm - point.x_mm;
  const double y = contact.centre_of_pressure.y_mm - point.y_mm;
  // The force points into the skin: its z is -normal.
  return {-y * contact.normal_n, x * contact.normal_n,
          contact.torque_nmm + x * contact.shear_y_n - y * contact.shear_x_n};
}

}  // namespace pillarfield
