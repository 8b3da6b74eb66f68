// pillarfield calibrate shear: shear coefficients from known tangential loads.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/calibrate/input.h"
#include "cli/calibrate/report.h"
#include "cli/number_text.h"
#include "pillarfield/printable.h"
#include "pillarfield/shear_calibration.h"

namespace pillarfield::cli {
namespace {

void warn_of_ambiguous(const ShearCommand& command, const ShearResult& result) {
  constexpr double kMuch = 0.05;
  for (std::size_t i = 0; i < result.loads.size(); ++i) {
    if (result.loads[i].ambiguous_share <= kMuch) continue;
    fmt::print(stderr,
               "{}: ambiguous pillars bear {:.0f} % of the load; press harder or pull less\n",
               printable(command.files[i]), 100 * result.loads[i].ambiguous_share);
  }
}

}  // namespace

void calibrate(const ShearCommand& command) {
  const StepInput input = read_input(command.files, command);
  std::vector<KnownShear> known;
  for (std::size_t i = 0; i < input.files.size(); ++i) {
    known.push_back({input.files[i], command.shears_n[2 * i], command.shears_n[2 * i + 1]});
    if (!command.loads_n.empty()) known.back().normal_n = command.loads_n[i];
  }
  const ShearResult result = calibrate_shear(input.calibration, known);
  const auto& [x, y] = result.coefficient;
  const auto& [error_x, error_y] = result.standard_error;
  const bool stored = result.calibration.planes.effects.shear_coefficient.has_value();
  StepReport report = {
      .headline = fmt::format("Calibrated with {}, {}", counted(known.size(), "tangential load"),
                              counted(input.frames, "frame")),
      .facts = {{"shear_coefficient_x", x, "c_x", fmt::format("± {:.4f}", error_x)},
                {"shear_coefficient_y", y, "c_y", fmt::format("± {:.4f}", error_y)},
                {"standard_error_x", error_x},
                {"standard_error_y", error_y},
                {"stored", stored}}};
  if (!stored) report.lines.emplace_back("Within two standard errors of 1: none is stored");
  auto loads = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < known.size(); ++i) {
    const ShearSum& sum = result.loads[i];
    loads.push_back({{"shear_x_n", known[i].shear_x_n},
                     {"shear_y_n", known[i].shear_y_n},
                     {"solved_x_n", sum.shear_x_n},
                     {"solved_y_n", sum.shear_y_n},
                     {"ambiguous_share", sum.ambiguous_share}});
    report.lines.push_back(fmt::format("  ({:.3f}, {:.3f}) N is solved as ({:.3f}, {:.3f}) N",
                                       known[i].shear_x_n, known[i].shear_y_n, sum.shear_x_n,
                                       sum.shear_y_n));
  }
  report.more.push_back({"loads", loads});
  warn_of_ambiguous(command, result);
  finish_step(command, result.calibration, "shear", command.files, input.frames,
              fmt::format("shears_n = {}, loads_n = {}, standard_error = {:.3g} {:.3g}",
                          fmt::join(command.shears_n, " "), fmt::join(command.loads_n, " "),
                          error_x, error_y),
              report);
}

}  // namespace pillarfield::cli
