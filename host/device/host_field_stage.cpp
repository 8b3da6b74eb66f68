#include "core/field_estimate.h"
#include "device/field_stage.h"

namespace pillarfield {
namespace {

float* floats_of(const SlotMemory& memory, std::size_t plane) {
  return reinterpret_cast<float*>(memory.host(plane));
}

class HostFieldStage final : public FieldStage {
 public:
  HostFieldStage(const SolverPlan& plan, std::size_t threads)
      : rows_(plan.skin.pillar_rows()), cols_(plan.skin.pillar_cols()), estimator_(plan, threads) {}

  void warm_up(const cl::CommandQueue&, SlotMemory&) override {}

  void resolve(const cl::CommandQueue&, SlotMemory& memory) override {
    const auto uncertainty = [&](Uncertainty plane) {
      return floats_of(memory, kUncertainty + static_cast<std::size_t>(plane));
    };
    const single_precision::Field field = {floats_of(memory, kShearX),
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
                                           rows_,
                                           cols_};
    estimator_.resolve(field, memory.silence());
  }

  [[nodiscard]] const ContactMap& contacts() const override { return estimator_.work().map(); }

 private:
  std::uint32_t rows_;
  std::uint32_t cols_;
  HostFieldEstimator estimator_;
};

}  // namespace

std::unique_ptr<FieldStage> host_field_stage(const Device::State& device, const SolverPlan& plan) {
  return std::make_unique<HostFieldStage>(plan,
                                          device.device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>());
}

}  // namespace pillarfield
