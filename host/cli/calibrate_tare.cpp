// pillarfield calibrate tare: readings and noise of the unloaded skin.

#include <fmt/format.h>

#include "cli/calibrate.h"
#include "cli/calibrate_input.h"
#include "cli/calibrate_report.h"
#include "cli/json_text.h"
#include "cli/number_range.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/printable.h"
#include "pillarfield/tare.h"

namespace pillarfield::cli {
namespace {

struct TareCommand {
  std::string unloaded;
  TareOptions tare;
  StepOptions step;
};

void print_json(const TareCommand& command, const TareResult& result, std::uint32_t frames) {
  nlohmann::ordered_json json = {{"output", command.step.output},
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
      "  threshold  {:8.2f} counts, {} times the noise that 99 % of them do not exceed\n",
      result.calibration.rows, result.calibration.cols, frames, result.tare_counts,
      result.noise_counts, *result.calibration.threshold_counts, command.tare.threshold_factor);
  print_findings(result.calibration, result.findings);
  fmt::print("Wrote {}\n", printable(command.step.output));
}

void run(const TareCommand& command) {
  const StepInput input = read_input({command.unloaded}, command.step);
  const FrameStatistics& unloaded = input.files.front();
  TareResult result = take_tare(input.before, unloaded, command.tare);
  result.calibration.history.push_back(
      step_done("tare", names_of({command.unloaded}), unloaded.frames(),
                fmt::format("threshold_factor = {}, preloaded = {}", command.tare.threshold_factor,
                            command.tare.preloaded)));
  write_calibration_file(command.step.output, result.calibration, command.step.replace);
  if (command.step.json) {
    print_json(command, result, unloaded.frames());
  } else {
    print_text(command, result, unloaded.frames());
  }
}

}  // namespace

void add_calibrate_tare(CLI::App& calibrate, Work& work) {
  const auto options = std::make_shared<TareCommand>();
  CLI::App* const command = calibrate.add_subcommand(
      "tare", "Tare, noise and threshold from frames of the unloaded skin");
  command->add_option("UNLOADED", options->unloaded, "Frames in which nothing touches the skin")
      ->required();
  command->add_option("--calibration", options->step.calibration,
                      "Calibration whose tare is renewed; what else it knows is kept [none]");
  command
      ->add_option("--threshold-factor", options->tare.threshold_factor,
                   "The threshold, as a multiple of the noise of a reading")
      ->check(number_range(0, kMaxThresholdFactor).description(""))
      ->capture_default_str();
  command->add_flag("--preloaded", options->tare.preloaded,
                    "Take as tare what looks like a touch: the skin is bent or covered there");
  add_step_options(*command, options->step, "Calibration to write (HDF5)");
  command->callback([options, &work] { work = [options] { run(*options); }; });
}

}  // namespace pillarfield::cli
