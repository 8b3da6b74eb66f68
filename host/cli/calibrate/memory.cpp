// pillarfield calibrate memory: hysteresis and creep under a known course of uniform pressure.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/pressure_log.h"
#include "cli/calibrate/report.h"
#include "cli/interrupt.h"
#include "cli/number_text.h"
#include "cli/progress.h"
#include "pillarfield/memory_calibration.h"

namespace pillarfield::cli {
namespace {

std::vector<std::string> files_and_logs(const MemoryCommand& command) {
  std::vector<std::string> files = command.files;
  files.insert(files.end(), command.logs.begin(), command.logs.end());
  return files;
}

MemoryResult find_memory(const MemoryCommand& command, std::uint64_t& frames) {
  check_step_output(files_and_logs(command), command, OutputKind::calibration);
  std::optional<MemoryFinder> finder;
  for (std::size_t i = 0; i < command.files.size(); ++i) {
    const PressureLog pressure(command.logs[i]);
    const std::unique_ptr<FrameSource> source = open_for_step(command.files[i], command);
    const SkinCalibration before = initial_calibration(command, *source, command.files[i]);
    WireCorrection correct = wire_correction(*source, command.files[i], before);
    if (!finder) finder.emplace(correct.skin(), before);
    finder->begin();
    FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
    Progress progress("Reading", source->frames(), command.quiet);
    for (std::uint64_t index = 0; index < source->frames(); ++index) {
      stop_if_interrupted_before(command.output);
      const double time_s = source->read(index, frame);
      finder->add(correct(frame.view()), time_s, pressure.at(time_s));
      progress.show(index + 1);
    }
    frames += source->frames();
  }
  return finder->result();
}

void add_memory(StepReport& report, const SenselMemory& memory) {
  auto plays = nlohmann::ordered_json::array();
  for (const Play& play : memory.plays) plays.push_back({play.width_counts, play.weight});
  auto creep = nlohmann::ordered_json::array();
  for (const Creep& state : memory.creep) {
    creep.push_back({state.time_s, state.weight});
    report.lines.push_back(
        fmt::format("  creep of {:.2f} % with {:.3g} s", 100 * state.weight, state.time_s));
  }
  report.more.push_back({"plays", plays});
  report.more.push_back({"creep", creep});
}

}  // namespace

void calibrate(const MemoryCommand& command) {
  std::uint64_t frames = 0;
  const MemoryResult result = find_memory(command, frames);
  StepReport report = {
      .headline = fmt::format("Found hysteresis and creep from {} up to {:.1f} counts",
                              counted(frames, "frame"), result.range_counts),
      .facts = {{"hysteresis", result.hysteresis, "hysteresis", "% of the range, at half of it"},
                {"creep_per_decade", result.creep_per_decade, "creep", "% in the last decade"},
                {"range_counts", result.range_counts},
                {"dead_zone_counts", result.dead_zone_counts, "dead zone", "counts"},
                {"curved", result.curved},
                {"residual_before", result.residual_before, "before",
                 "% of the range, RMS without memory"},
                {"residual_after", result.residual_after, "after", "% of the range, RMS left"},
                {"stored", result.found}}};
  add_memory(report, result.memory);
  if (!result.found) report.lines.emplace_back("The readings show no memory: none is stored");
  if (result.found && result.curved) report.lines.emplace_back("The response curve is fitted anew");
  add_residual(report, result.calibration.planes.effects);
  finish_step(command, result.calibration, "memory", command.files, frames,
              fmt::format("hysteresis = {:.4f}, creep_per_decade = {:.4f}, residual = {:.4f}",
                          result.hysteresis, result.creep_per_decade, result.residual_after),
              report);
}

}  // namespace pillarfield::cli
