// pillarfield calibrate STEP: the steps of calibration/steps.h, on files.

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <utility>

#include "base/number_text.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/json_text.h"
#include "cli/progress.h"
#include "cli/warnings.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

/// Findings that the text lists; JSON has all.
constexpr std::size_t kMostFindings = 20;

/// Throws Error where the output cannot be written or is an input.
void check_step_output(const StepCommand& command) {
  std::vector<std::filesystem::path> inputs(command.files.begin(), command.files.end());
  inputs.insert(inputs.end(), command.logs.begin(), command.logs.end());
  inputs.emplace_back(command.calibration);
  check_outputs(inputs, {{command.output, OutputKind::calibration}}, command.replace);
}

StepFrames frames_of(const std::string& file, const StepCommand& command) {
  const std::shared_ptr<FrameSource> source =
      open_frames_with_warnings(file, command.read, command.quiet);
  const auto for_each = [source, &command](const StepFrames::Use& use) {
    FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
    Progress progress("Reading", source->frames(), command.quiet);
    for (std::uint64_t index = 0; index < source->frames(); ++index) {
      stop_if_interrupted_before(command.output);
      const double time_s = source->read(index, frame);
      use(frame.view(), time_s);
      progress.show(index + 1);
    }
  };
  return {.file = file,
          .skin = source->skin(),
          .sensel_type = source->sensel_type(),
          .layout = command.read.layout,
          .sensel_pitch_mm = command.read.sensel_pitch_mm,
          .mask = source->calibration().mask,
          .frames = source->frames(),
          .for_each = for_each};
}

StepResult result_of(const StepCommand& command) {
  StepValues values = command.values;
  for (const std::string& log : command.logs) values.logs.emplace_back(log);
  std::vector<StepFrames> files;
  for (const std::string& file : command.files) files.push_back(frames_of(file, command));
  std::optional<SkinCalibration> before;
  if (!command.calibration.empty()) {
    before = read_calibration_file(command.calibration, command.read);
  }
  return run_step(*command.step, std::move(files), std::move(before), std::move(values));
}

void print_findings(const StepResult& result) {
  const auto& findings = result.report.facts["findings"];
  const SkinCalibration& calibration = result.calibration;
  fmt::print("Masked: {} of {} sensels\n",
             grouped(result.report.facts["masked"].get<std::size_t>()),
             grouped(std::size_t{calibration.rows} * calibration.cols));
  const std::size_t shown = std::min(findings.size(), kMostFindings);
  for (std::size_t i = 0; i < shown; ++i) {
    const auto& finding = findings[i];
    fmt::print("  row {}, column {}: {}, reads {:.1f} counts{}\n",
               finding["row"].get<std::uint32_t>(), finding["col"].get<std::uint32_t>(),
               finding["fault"].get<std::string>(), finding["mean_counts"].get<double>(),
               finding["masked"].get<bool>() ? "" : "; not masked");
  }
  if (shown < findings.size()) {
    fmt::print("  and {} more; --json lists all\n", findings.size() - shown);
  }
}

void print_text(const StepCommand& command, const StepResult& result) {
  const StepReport& report = result.report;
  fmt::print("{}\n", report.headline);
  for (const std::string& line : report.measures) fmt::print("{}\n", line);
  if (report.facts.contains("findings")) print_findings(result);
  for (const std::string& line : report.notes) fmt::print("{}\n", line);
  fmt::print("Wrote {}\n", printable(command.output));
}

void print_json(const StepCommand& command, const StepResult& result) {
  nlohmann::ordered_json json = {{"output", command.output},
                                 {"frames", result.calibration.history.back().frames}};
  json.update(result.report.facts);
  fmt::print("{}\n", json_text(json));
}

}  // namespace

void calibrate(const StepCommand& command) {
  check_step_output(command);
  const StepResult result = result_of(command);
  for (const std::string& warning : result.report.warnings) {
    fmt::print(stderr, "{}\n", printable(warning));
  }
  write_calibration_file(command.output, result.calibration, command.replace);
  if (command.json) {
    print_json(command, result);
  } else if (!command.quiet) {
    print_text(command, result);
  }
}

}  // namespace pillarfield::cli
