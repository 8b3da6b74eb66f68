#include "fuzz/targets.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::fuzz {

void read_calibration(const std::filesystem::path& path,
                      [[maybe_unused]] const ReadOptions& options) {
  (void)is_calibration_file(path, options);
  const SkinCalibration calibration = read_calibration_file(path, options);
  SolverPlan plan;
  plan.skin.rows = calibration.rows;
  plan.skin.cols = calibration.cols;
  apply(calibration, plan.skin, plan.calibration);
  check(plan, path.native());
}

}  // namespace pillarfield::fuzz
