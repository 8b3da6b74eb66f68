#include "bench/noisy_frame_store.h"

#include "bench/solve_variant.h"

namespace pillarfield::bench {

const NoisyFrames& NoisyFrameStore::bare() {
  if (!bare_) bare_.emplace(plan_of(SolveVariant{}, pillars_a_side_), count_);
  return *bare_;
}

const NoisyFrames& NoisyFrameStore::of(const SolverPlan& plan) {
  const Kind wanted = {plan.sensel_type, !plan.calibration.empty()};
  if (wanted == Kind{SenselType::u8, false}) return bare();
  if (!last_ || wanted != last_kind_) {
    last_.reset();  // Before the next allocation.
    last_.emplace(plan, count_);
    last_kind_ = wanted;
  }
  return *last_;
}

}  // namespace pillarfield::bench
