#include "pillarfield/sensel_finding.h"

namespace pillarfield {

const char* name_of(SenselFault fault) {
  switch (fault) {
    case SenselFault::not_a_number:
      return "not a number";
    case SenselFault::saturated:
      return "saturated";
    case SenselFault::stuck:
      return "stuck";
    case SenselFault::noisy:
      return "noisy";
    case SenselFault::unresponsive:
      return "unresponsive";
    case SenselFault::unequal:
      return "unequal";
    case SenselFault::unknown:
      break;
  }
  return "unknown";
}

}  // namespace pillarfield
