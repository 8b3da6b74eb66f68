// pillarfield calibrate wires: resistance of the wires of a scanned array.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/wire_calibration.h"

namespace pillarfield::cli {
namespace {

const char* name_of(TareOrigin tares) { return tares == TareOrigin::offset ? "offset" : "conduct"; }

/// What the frames tell of the tares, and how they are taken.
std::string tares_text(const WireResult& result) {
  const std::string taken = result.wires.tares == TareOrigin::offset
                                ? "Tares are taken as an offset behind the wires"
                                : "Tares are taken as conductance";
  if (!result.tares_shown) return taken + "; the frames do not tell";
  return fmt::format("{}; {:.2f} of them conducts", taken, result.conducting_share);
}

}  // namespace

void calibrate(const WiresCommand& command) {
  const StepInput input = read_input(command.files, command, WireUse::none);
  const WireResult result =
      calibrate_wires(input.calibration, input.files, command.tile, command.tares);
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
                {"tares", name_of(wires.tares)},
                {"conducting_share", result.conducting_share},
                {"stored", result.found}},
      .findings = nullptr,
      .more = {},
      .lines = {"Resistance times conductance of a count, in millionths:",
                "  row     " + millionths(wires.row_per_count, error.row_per_count),
                "  column  " + millionths(wires.column_per_count, error.column_per_count),
                "  idle    " + millionths(wires.idle_per_count, error.idle_per_count),
                tares_text(result)}};
  if (result.found && result.tares_shown.value_or(wires.tares) != wires.tares) {
    fmt::print(stderr, "--tares {}: the frames show {}; leave the option out, or check it\n",
               name_of(wires.tares), name_of(*result.tares_shown));
  }
  if (!result.found) report.lines.emplace_back("Within three standard errors of 0: none is stored");
  finish_step(command, result.calibration, "wires", command.files, input.frames,
              fmt::format("tile = {} x {}, tares = {}", command.tile.rows, command.tile.cols,
                          name_of(wires.tares)),
              report);
}

}  // namespace pillarfield::cli
