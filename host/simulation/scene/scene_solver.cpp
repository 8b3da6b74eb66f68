#include "pillarfield/scene.h"

namespace pillarfield {

void set_solver(SolverPlan& plan, const Scene& scene) {
  plan.parity_tolerance_counts = scene.parity_tolerance_counts;
  plan.estimator = scene.estimator;
  plan.friction = scene.friction;
  plan.angles = scene.angles;
  plan.uncertainty = scene.uncertainty;
  plan.frame_interval_s = 1 / scene.rate_hz;
  if (scene.baseline_time_s) {
    plan.baseline_rate = baseline_rate(*scene.baseline_time_s, 1 / scene.rate_hz);
  }
  if (scene.sensor.noise_counts > 0) plan.noise_counts = scene.sensor.noise_counts;
}

}  // namespace pillarfield
