// pillarfield calibrate wires: resistance of the wires of a scanned array.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/wire_calibration.h"

namespace pillarfield::cli {

void calibrate(const WiresCommand& command) {
  const StepInput input = read_input(command.files, command);
  const WireResult result = calibrate_wires(input.calibration, input.files, command.tile);
  const WireCrosstalk& wires = result.wires;
  const WireCrosstalk& error = result.standard_error;
  const auto millionths = [](double value, double deviation) {
    return fmt::format("{:.3f} ± {:.3f}", 1e6 * value, 1e6 * deviation);
  };
  StepReport report = {
      .headline = fmt::format("Compared {} in {}", counted(result.sensels, "sensel"),
                              counted(input.files.size(), "file")),
      .facts = {{"row_per_count", wires.row_per_count},
                {"column_per_count", wires.column_per_count},
                {"idle_per_count", wires.idle_per_count},
                {"row_error", error.row_per_count},
                {"column_error", error.column_per_count},
                {"idle_error", error.idle_per_count},
                {"sensels", result.sensels},
                {"residual_before", result.residual_before, "before",
                 "% change of their readings under other loads"},
                {"residual_after", result.residual_after, "after", "% left"},
                {"stored", result.found}},
      .findings = nullptr,
      .more = {},
      .lines = {"Resistance times conductance of a count, in millionths:",
                "  row     " + millionths(wires.row_per_count, error.row_per_count),
                "  column  " + millionths(wires.column_per_count, error.column_per_count),
                "  idle    " + millionths(wires.idle_per_count, error.idle_per_count)}};
  if (!result.found) report.lines.emplace_back("Within three standard errors of 0: none is stored");
  finish_step(command, result.calibration, "wires", command.files, input.frames,
              fmt::format("tile = {} x {}", command.tile.rows, command.tile.cols), report);
}

}  // namespace pillarfield::cli
