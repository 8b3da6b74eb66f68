#include "device/slot.h"

namespace pillarfield {
namespace {

/// Planes of a result in host memory.
FieldPlanes planes_of(const ResultMemory& memory) {
  FieldPlanes planes;
  planes.rows = memory.layout().rows;
  planes.cols = memory.layout().cols;
  planes.status = memory.status();
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    plane_of(planes, i) = reinterpret_cast<float*>(memory.plane(i));
  }
  return planes;
}

}  // namespace

ContactStage::ContactStage(const SolverPlan& plan, std::size_t threads)
    : estimator_(plan, threads) {}

void ContactStage::resolve(const ResultMemory& memory) {
  estimator_.resolve(planes_of(memory), memory.idle_blocks());
}

FoundContacts Slot::contacts() const {
  const IdleBlocks& idle = memory().idle_blocks();
  return {nullptr, {}, has_pillars_ && !idle.flags.empty() ? &idle : nullptr};
}

}  // namespace pillarfield
