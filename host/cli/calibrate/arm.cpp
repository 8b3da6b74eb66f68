// pillarfield calibrate arm: arm of off-centre pressure from bodies pressed straight down.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/arm_calibration.h"

namespace pillarfield::cli {

void calibrate(const ArmCommand& command) {
  const StepInput input = read_input(command.files, command);
  const ArmResult result = calibrate_arm(input.calibration, input.files);
  StepReport report = {
      .headline = fmt::format("Calibrated with {} at {}, {}", counted(result.pillars, "pillar"),
                              counted(result.places, "place"), counted(input.frames, "frame")),
      .facts = {{"pillars", result.pillars},
                {"places", result.places},
                {"shear_before_n", result.shear_before_n},
                {"shear_after_n", result.shear_after_n},
                {"left", result.shear_after_n / result.shear_before_n, "left",
                 "% of the shear that the pillars read"},
                {"stored", result.found}}};
  if (result.found) {
    report.facts.push_back({"arm_mm", result.arm_mm, "arm",
                            fmt::format("mm ± {:.1f} %", 100 * result.standard_error)});
    report.facts.push_back({"standard_error", result.standard_error});
  } else {
    report.lines.push_back(
        fmt::format("No off-centre pressure within three standard errors: an arm is longer than "
                    "{:.3g} mm; none "
                    "is stored",
                    result.longest_mm));
  }
  finish_step(
      command, result.calibration, "arm", command.files, input.frames,
      fmt::format("places = {}, standard_error = {:.3g}", result.places, result.standard_error),
      report);
}

}  // namespace pillarfield::cli
