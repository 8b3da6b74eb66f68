// pillarfield calibrate bending: change of the tares with curvature, from known cylinders.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/bending_calibration.h"

namespace pillarfield::cli {

void calibrate(const BendingCommand& command) {
  const StepInput input = read_input(command.files, command, WireUse::unloaded);
  std::vector<BentSkin> shapes;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    shapes.push_back(
        {input.files[i], curvature_of_cylinder(command.radii_mm[i], command.axes_deg[i])});
  }
  const BendingResult result = calibrate_bending(input.calibration, shapes);
  const auto unit = [&](std::size_t p) {
    return fmt::format("counts·mm, RMS of the sensels, each ± {:.2f}", result.standard_error[p]);
  };
  StepReport report = {
      .headline = fmt::format("Bent around {}, {}", counted(shapes.size(), "cylinder"),
                              counted(input.frames, "frame")),
      .facts = {
          {"bend_x_rms", result.rms[0], "bend_x", unit(0)},
          {"bend_y_rms", result.rms[1], "bend_y", unit(1)},
          {"bend_xy_rms", result.rms[2], "bend_xy", unit(2)},
          {"standard_errors", result.standard_error},
          {"residual_before", result.residual_before, "before", "counts, RMS change of tares"},
          {"residual_after", result.residual_after, "after", "counts, RMS left"},
          {"stored", result.found}}};
  if (!result.found) report.lines.emplace_back("Within the noise: none is stored");
  finish_step(command, result.calibration, "bending", command.files, input.frames,
              fmt::format("radii_mm = {}, axes_deg = {}", fmt::join(command.radii_mm, " "),
                          fmt::join(command.axes_deg, " ")),
              report);
}

}  // namespace pillarfield::cli
