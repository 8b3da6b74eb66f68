#include "device/contact_stage.h"

namespace pillarfield {
namespace {

/// Planes of a result in host memory.
FieldPlanes planes_of(const ResultMemory& memory, std::uint32_t rows, std::uint32_t cols) {
  FieldPlanes planes;
  planes.rows = rows;
  planes.cols = cols;
  planes.status = memory.status();
  for (std::size_t i = 0; i < kSolvedPlanes; ++i) {
    plane_of(planes, i) = reinterpret_cast<float*>(memory.plane(i));
  }
  return planes;
}

}  // namespace

ContactStage::ContactStage(const SolverPlan& plan, std::size_t threads)
    : rows_(plan.skin.pillar_rows()), cols_(plan.skin.pillar_cols()), estimator_(plan, threads) {}

void ContactStage::resolve(const ResultMemory& memory) {
  estimator_.resolve(planes_of(memory, rows_, cols_), memory.idle_blocks());
}

}  // namespace pillarfield
