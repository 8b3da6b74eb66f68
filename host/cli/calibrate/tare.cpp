// pillarfield calibrate tare: tare and noise of the unloaded skin.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/untouched_skin.h"

namespace pillarfield::cli {

void calibrate(const TareCommand& command) {
  const StepInput input = read_input({command.unloaded}, command, WireUse::unloaded);
  const TareOptions& tare = command.tare;
  const TareResult result = take_tare(input.calibration, input.files.front(), tare);
  const SkinCalibration& calibration = result.calibration;
  finish_step(
      command, calibration, "tare", {command.unloaded}, input.frames,
      fmt::format("threshold_factor = {}, preloaded = {}", tare.threshold_factor, tare.preloaded),
      {.headline = fmt::format("Tare of {} x {} sensels from {}", calibration.rows,
                               calibration.cols, counted(input.frames, "frame")),
       .facts = {{"tare_counts", result.tare_counts, "tare", "counts, median of the valid sensels"},
                 {"noise_counts", result.noise_counts, "noise",
                  "counts, median of the valid sensels"},
                 {"untouched_share", untouched_share(calibration), "untouched",
                  "% of the untouched pillars would have a status"},
                 {"threshold_counts", *calibration.threshold_counts, "threshold",
                  fmt::format("counts, {:g} times the 99th percentile of the noise",
                              tare.threshold_factor)}},
       .findings = &result.findings});
}

}  // namespace pillarfield::cli
