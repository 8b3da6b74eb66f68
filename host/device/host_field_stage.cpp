#include <algorithm>
#include <thread>

#include "contacts/contact_estimator.h"
#include "core/field_estimate.h"
#include "device/field_stage.h"

namespace pillarfield {
namespace {

float* floats_of(const SlotMemory& memory, std::size_t plane) {
  return reinterpret_cast<float*>(memory.host(plane));
}

/// The host's side of a result's planes.
single_precision::Field field_of(const SlotMemory& memory, std::uint32_t rows, std::uint32_t cols) {
  const auto uncertainty = [&](Uncertainty plane) {
    return floats_of(memory, kUncertainty + static_cast<std::size_t>(plane));
  };
  return {floats_of(memory, kShearX),
          floats_of(memory, kShearY),
          floats_of(memory, kNormal),
          reinterpret_cast<std::uint8_t*>(memory.host(kStatus)),
          floats_of(memory, kMagnitude),
          floats_of(memory, kTheta),
          floats_of(memory, kPhi),
          uncertainty(Uncertainty::shear_x),
          uncertainty(Uncertainty::shear_y),
          uncertainty(Uncertainty::normal),
          uncertainty(Uncertainty::theta_low),
          uncertainty(Uncertainty::theta_high),
          uncertainty(Uncertainty::phi_low),
          uncertainty(Uncertainty::phi_high),
          uncertainty(Uncertainty::magnitude_low),
          uncertainty(Uncertainty::magnitude_high),
          rows,
          cols};
}

const ContactMap& contacts_of(const HostFieldEstimator& estimator) {
  return estimator.work().map();
}
const ContactMap& contacts_of(const ContactEstimator& estimator) { return estimator.contacts(); }

/// An estimator that works on the host's side of the planes.
template <class HostEstimator>
class HostStage final : public FieldStage {
 public:
  HostStage(const SolverPlan& plan, std::size_t threads)
      : rows_(plan.skin.pillar_rows()), cols_(plan.skin.pillar_cols()), estimator_(plan, threads) {}

  void warm_up(const cl::CommandQueue&, SlotMemory&) override {}

  void resolve(const cl::CommandQueue&, SlotMemory& memory) override {
    estimator_.resolve(field_of(memory, rows_, cols_), memory.silence());
  }

  [[nodiscard]] const ContactMap& contacts() const override { return contacts_of(estimator_); }

 private:
  std::uint32_t rows_;
  std::uint32_t cols_;
  HostEstimator estimator_;
};

}  // namespace

std::unique_ptr<FieldStage> host_field_stage(const Device::State& device, const SolverPlan& plan) {
  return std::make_unique<HostStage<HostFieldEstimator>>(
      plan, device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
}

std::unique_ptr<FieldStage> contact_stage(const Device::State& device, const SolverPlan& plan) {
  // A device that is the host's processor has as many compute units as threads may be used.
  const bool is_host = device.device.getInfo<CL_DEVICE_TYPE>() == CL_DEVICE_TYPE_CPU;
  const std::size_t threads = is_host ? device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()
                                      : std::thread::hardware_concurrency();
  return std::make_unique<HostStage<ContactEstimator>>(plan, std::max<std::size_t>(threads, 1));
}

}  // namespace pillarfield
