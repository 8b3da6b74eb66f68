// pillarfield calibrate leak: leaks between sensels and pillars from a fine tip.

#include <fmt/format.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/interrupt.h"
#include "cli/number_text.h"
#include "cli/progress.h"
#include "pillarfield/leak_calibration.h"

namespace pillarfield::cli {
namespace {

LeakResult find_leak(const LeakCommand& command, std::uint64_t& frames) {
  check_step_output(command.files, command, OutputKind::calibration);
  std::optional<LeakFinder> finder;
  for (const std::string& file : command.files) {
    const std::unique_ptr<FrameSource> source = open_for_step(file, command);
    const SkinCalibration calibration = initial_calibration(command, *source, file);
    WireCorrection correct = wire_correction(*source, file, calibration);
    if (!finder) finder.emplace(correct.skin(), calibration);
    FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
    Progress progress("Reading", source->frames(), command.quiet);
    for (std::uint64_t index = 0; index < source->frames(); ++index) {
      stop_if_interrupted_before(command.output);
      source->read(index, frame);
      finder->add(correct(frame.view()));
      progress.show(index + 1);
    }
    frames += source->frames();
  }
  return finder->result();
}

std::string percent_error(double error) { return fmt::format("% ± {:.3f}", 100 * error); }

}  // namespace

void calibrate(const LeakCommand& command) {
  std::uint64_t frames = 0;
  const LeakResult result = find_leak(command, frames);
  const auto& [sensel, pillar] = result.leak;
  const auto& [sensel_error, pillar_error] = result.standard_error;
  const SensorEffects& effects = result.calibration.planes.effects;
  StepReport report = {
      .headline = fmt::format("Found leaks from presses: {}, on {}", grouped(result.presses),
                              counted(result.places, "pillar")),
      .facts = {{"leak_inside", sensel.inside, result.inside_known ? "inside" : "",
                 percent_error(sensel_error.inside)},
                {"leak_across", sensel.across, "across", percent_error(sensel_error.across)},
                {"pillar_leak_edge", pillar.edge, "pillar edge", percent_error(pillar_error.edge)},
                {"pillar_leak_corner", pillar.corner, "corner", percent_error(pillar_error.corner)},
                {"leak_inside_error", sensel_error.inside},
                {"leak_across_error", sensel_error.across},
                {"pillar_leak_edge_error", pillar_error.edge},
                {"pillar_leak_corner_error", pillar_error.corner},
                {"inside_known", result.inside_known},
                {"presses", result.presses},
                {"left_out", result.left_out},
                {"places", result.places},
                {"residual_before", result.residual_before, "before", "% read by unloaded sensels"},
                {"residual_after", result.residual_after, "after", "% left"},
                {"stored_between_sensels", effects.sensel_leak.has_value()},
                {"stored_between_pillars", effects.pillar_leak.has_value()}}};
  if (!result.inside_known) {
    report.lines.emplace_back(
        "Inside: unknown, since no pressed pillar has an inactive sensel; pull the tip sideways");
  }
  if (!effects.sensel_leak)
    report.lines.emplace_back("Between sensels: none within 3 standard errors");
  if (!effects.pillar_leak)
    report.lines.emplace_back("Between pillars: none within 3 standard errors");
  if (const auto& k = result.calibration.counts_per_newton) {
    report.facts.push_back(
        {"counts_per_newton", *k, "sensitivity", "counts per newton and pillar"});
  }
  finish_step(command, result.calibration, "leak", command.files, frames,
              fmt::format("presses = {}, places = {}, left_out = {}", result.presses, result.places,
                          result.left_out),
              report);
}

}  // namespace pillarfield::cli
