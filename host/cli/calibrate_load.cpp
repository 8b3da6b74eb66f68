// pillarfield calibrate load: counts per newton, and a power law, from known loads.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate_input.h"
#include "cli/json_text.h"
#include "pillarfield/calibration_file.h"
#include "pillarfield/load_calibration.h"
#include "pillarfield/printable.h"

namespace pillarfield::cli {
namespace {

/// Beyond this share the load stands on pillars that are ambiguous.
constexpr double kMuchAmbiguous = 0.05;

const char* name_of(LoadModel model) { return model == LoadModel::power ? "power" : "linear"; }

void print_json(const LoadCommand& command, const LoadResult& result, std::uint64_t frames) {
  const SkinCalibration& calibration = result.calibration;
  nlohmann::ordered_json json = {{"output", command.output},
                                 {"frames", frames},
                                 {"model", name_of(command.model)},
                                 {"counts_per_newton", *calibration.counts_per_newton},
                                 {"least_counts_per_newton", result.least_counts_per_newton},
                                 {"most_counts_per_newton", result.most_counts_per_newton},
                                 {"misfit", result.misfit}};
  if (calibration.power_law) {
    json["power_law_exponent"] = calibration.power_law->exponent;
    json["power_law_reference_counts"] = calibration.power_law->reference_counts;
  }
  json["loads"] = nlohmann::ordered_json::array();
  for (const LoadResidual& load : result.loads) {
    json["loads"].push_back({{"load_n", load.load_n},
                             {"solved_n", load.solved_n},
                             {"ambiguous_share", load.ambiguous_share},
                             {"saturated", load.saturated}});
  }
  fmt::print("{}\n", json_text(json));
}

void print_text(const LoadCommand& command, const LoadResult& result, std::uint64_t frames) {
  const SkinCalibration& calibration = result.calibration;
  fmt::print(
      "Calibrated with {} load{}, {} frames\n"
      "  sensitivity  {:8.2f} counts per newton and pillar, {:.2f} to {:.2f} as ambiguous pillars "
      "allow\n",
      result.loads.size(), result.loads.size() == 1 ? "" : "s", frames,
      *calibration.counts_per_newton, result.least_counts_per_newton,
      result.most_counts_per_newton);
  if (calibration.power_law) {
    fmt::print("  power law    exponent {:.4f}, reference {:.2f} counts\n",
               calibration.power_law->exponent, calibration.power_law->reference_counts);
  }
  for (const LoadResidual& load : result.loads) {
    fmt::print("  {:8.3f} N is solved as {:8.3f} N ({:+.2f} %), {:.1f} % of it ambiguous\n",
               load.load_n, load.solved_n, 100 * (load.solved_n / load.load_n - 1),
               100 * load.ambiguous_share);
  }
  fmt::print("Wrote {}\n", printable(command.output));
}

void print_remarks(const LoadCommand& command, const LoadResult& result) {
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    const LoadResidual& load = result.loads[i];
    if (load.ambiguous_share > kMuchAmbiguous) {
      fmt::print(stderr,
                 "{}: {:.0f} % of the load stands on ambiguous pillars; press flat and without "
                 "shear\n",
                 printable(command.files[i]), 100 * load.ambiguous_share);
    }
    if (load.saturated > 0) {
      fmt::print(stderr, "{}: {} pillars have a saturated sensel and lack force; press less\n",
                 printable(command.files[i]), load.saturated);
    }
  }
}

}  // namespace

void calibrate(const LoadCommand& command) {
  const StepInput input = read_input(command.files, command);
  std::vector<KnownLoad> loads;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    loads.push_back({input.files[i], command.loads_n[i]});
  }
  LoadResult result = calibrate_load(input.before, loads, command.model);
  result.calibration.history.push_back(
      step_done("load", names_of(command.files), input.frames,
                fmt::format("loads_n = {}, model = {}", fmt::join(command.loads_n, " "),
                            name_of(command.model))));
  write_calibration_file(command.output, result.calibration, command.replace);
  print_remarks(command, result);
  if (command.json) {
    print_json(command, result, input.frames);
  } else if (!command.quiet) {
    print_text(command, result, input.frames);
  }
}

}  // namespace pillarfield::cli
