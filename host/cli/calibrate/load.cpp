// pillarfield calibrate load: counts per newton, and a power law, from known loads.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

/// Largest fraction of a load on ambiguous pillars without a warning.
constexpr double kMuchAmbiguous = 0.05;

const char* name_of(LoadModel model) { return model == LoadModel::power ? "power" : "linear"; }

void warn_of_loads(const LoadCommand& command, const std::vector<LoadResidual>& loads) {
  for (std::size_t i = 0; i < loads.size(); ++i) {
    if (loads[i].ambiguous_share > kMuchAmbiguous) {
      fmt::print(stderr,
                 "{}: ambiguous pillars bear {:.0f} % of the load; press flat and without shear\n",
                 printable(command.files[i]), 100 * loads[i].ambiguous_share);
    }
    if (loads[i].saturated > 0) {
      fmt::print(stderr, "{}: {} pillars have a saturated sensel, which hides force; press less\n",
                 printable(command.files[i]), loads[i].saturated);
    }
  }
}

}  // namespace

void calibrate(const LoadCommand& command) {
  const StepInput input = read_input(command.files, command);
  std::vector<KnownLoad> known;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    known.push_back({input.files[i], command.loads_n[i]});
  }
  const LoadResult result = calibrate_load(input.calibration, known, command.model);
  const SkinCalibration& calibration = result.calibration;
  StepReport report = {
      .headline = fmt::format("Calibrated with {}, {}", counted(known.size(), "load"),
                              counted(input.frames, "frame")),
      .facts = {
          {"model", name_of(command.model)},
          {"counts_per_newton", *calibration.counts_per_newton, "sensitivity",
           fmt::format("counts per newton and pillar, {:.2f} to {:.2f} with ambiguous pillars",
                       result.least_counts_per_newton, result.most_counts_per_newton)},
          {"least_counts_per_newton", result.least_counts_per_newton},
          {"most_counts_per_newton", result.most_counts_per_newton},
          {"misfit", result.misfit}}};
  if (const auto& law = calibration.power_law) {
    report.facts.push_back({"power_law_exponent", law->exponent, "exponent", "of the power law"});
    report.facts.push_back({"power_law_reference_counts", law->reference_counts, "reference",
                            "counts, of the power law"});
  }
  auto loads = nlohmann::ordered_json::array();
  for (const LoadResidual& load : result.loads) {
    loads.push_back({{"load_n", load.load_n},
                     {"solved_n", load.solved_n},
                     {"ambiguous_share", load.ambiguous_share},
                     {"saturated", load.saturated}});
    report.lines.push_back(fmt::format(
        "  {:8.3f} N is solved as {:8.3f} N ({:+.2f} %), {:.1f} % of it on ambiguous pillars",
        load.load_n, load.solved_n, 100 * (load.solved_n / load.load_n - 1),
        100 * load.ambiguous_share));
  }
  report.more.push_back({"loads", loads});
  add_residual(report, calibration.planes.effects);
  warn_of_loads(command, result.loads);
  finish_step(command, calibration, "load", command.files, input.frames,
              fmt::format("loads_n = {}, model = {}", fmt::join(command.loads_n, " "),
                          name_of(command.model)),
              report);
}

}  // namespace pillarfield::cli
