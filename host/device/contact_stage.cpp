#include "device/contact_stage.h"

#include <algorithm>
#include <thread>

namespace pillarfield {
namespace {

/// Threads: the compute units of a device that is the host's processor.
std::size_t threads_for(const Device::State& device) {
  const bool is_host = device.device.getInfo<CL_DEVICE_TYPE>() == CL_DEVICE_TYPE_CPU;
  const std::size_t threads = is_host ? device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()
                                      : std::thread::hardware_concurrency();
  return std::max<std::size_t>(threads, 1);
}

/// Planes of a result in host memory.
FieldPlanes planes_of(const SlotMemory& memory, std::uint32_t rows, std::uint32_t cols) {
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

ContactStage::ContactStage(const Device::State& device, const SolverPlan& plan)
    : rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      estimator_(plan, threads_for(device)) {}

void ContactStage::resolve(const SlotMemory& memory) {
  estimator_.resolve(planes_of(memory, rows_, cols_), memory.idle_blocks());
}

}  // namespace pillarfield
