// pillarfield calibrate tare: readings and noise of the unloaded skin.

#include <fmt/format.h>

#include "cli/calibrate_input.h"
#include "cli/calibrate_report.h"
#include "cli/json_text.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/printable.h"
#include "pillarfield/tare.h"

namespace pillarfield::cli {
namespace {

void print_json(const TareCommand& command, const TareResult& result, std::uint32_t frames) {
  nlohmann::ordered_json json = {{"output", command.output},
                                 {"frames", frames},
                                 {"tare_counts", result.tare_counts},
                                 {"noise_counts", result.noise_counts},
                                 {"threshold_counts", *result.calibration.threshold_counts}};
  add_findings(json, result.calibration, result.findings);
  fmt::print("{}\n", json_text(json));
}

void print_text(const TareCommand& command, const TareResult& result, std::uint32_t frames) {
  fmt::print(
      "Tare of {} x {} sensels from {} frames\n"
      "  tare       {:8.2f} counts, the median of the good sensels\n"
      "  noise      {:8.2f} counts, the same\n"
      "  threshold  {:8.2f} counts, {:g} times the noise that 99 % of them do not exceed\n",
      result.calibration.rows, result.calibration.cols, frames, result.tare_counts,
      result.noise_counts, *result.calibration.threshold_counts, command.tare.threshold_factor);
  print_findings(result.calibration, result.findings);
  fmt::print("Wrote {}\n", printable(command.output));
}

}  // namespace

void calibrate(const TareCommand& command) {
  const StepInput input = read_input({command.unloaded}, command);
  const FrameStatistics& unloaded = input.files.front();
  TareResult result = take_tare(input.before, unloaded, command.tare);
  result.calibration.history.push_back(
      step_done("tare", names_of({command.unloaded}), unloaded.frames(),
                fmt::format("threshold_factor = {}, preloaded = {}", command.tare.threshold_factor,
                            command.tare.preloaded)));
  write_calibration_file(command.output, result.calibration, command.replace);
  if (command.json) {
    print_json(command, result, unloaded.frames());
  } else if (!command.quiet) {
    print_text(command, result, unloaded.frames());
  }
}

}  // namespace pillarfield::cli
