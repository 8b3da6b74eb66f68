#include "solve/result_planes.h"

namespace pillarfield {

// The enumeration of the public header must have the order of the table.
#define PF_PLANE(name, unit, value) Uncertainty::name,
static_assert([] {
  constexpr std::array kTable = {PF_UNCERTAINTY_PLANES(PF_PLANE)};
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (kTable[i] != static_cast<Uncertainty>(i)) return false;
  }
  return kTable.size() == kUncertaintyPlanes;
}());
#undef PF_PLANE

const char* ResultPlane::group() const {
  const bool in_force =
      set == PlaneSet::forces || set == PlaneSet::angles || set == PlaneSet::pressure;
  return in_force ? "force" : "uncertainty";
}

std::string ResultPlane::field() const {
  return index < kNamedPlanes || set == PlaneSet::pressure ? name
                                                           : std::string(group()) + "_" + name;
}

const char* name_of(Uncertainty plane) {
  return kResultPlanes[kNamedPlanes + static_cast<std::size_t>(plane)].name;
}

const char* name_of(ComponentEnd end) {
  return kResultPlanes[kSolvedPlanes + static_cast<std::size_t>(end)].name;
}

}  // namespace pillarfield
