// What each piece of evidence is worth.

#include <fmt/format.h>

#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Evidence

The ratio of the RMS errors, field over the paper's midpoint, with each piece of evidence that the estimator may go by, alone and together, and with what a
scene may tell; noise {noise:g}. "Nothing said" uses what the readings themselves show, shape and slip, and is the default. "Friction told" gives the true friction as a bound; "that it slips"
also says that every pillar slips, for scenes where it is so. "The frames before": {frames} frames, in which the shear grows evenly
from nothing while the pressure stays, each solved with the help of that before; the last one counts.

)";

}  // namespace

std::string evidence_section(const FieldContext& context) {
  std::vector<std::string> header = {""};
  header.emplace_back("middle of the segment");
  for (const auto& method : field_study::methods()) header.push_back(method.name);
  header.emplace_back("noise alone");
  Table table("l" + std::string(header.size() - 1, 'r'), header);
  for (const Kind& kind : kinds()) {
    if (kind.name == "press, any") continue;
    const auto of_middle = pool(
        context.judging,
        [&](const SceneResult& result) {
          return kind.holds(result.scene) && result.scene.noise_counts == kTypicalNoise;
        },
        [](const SceneResult& result) { return std::optional(result.middle); });
    std::vector<std::string> cells = {kind.name, ratio_text(of_middle)};
    for (std::size_t method = 0; method < field_study::methods().size(); ++method) {
      cells.push_back(ratio_text(pool_method(context.judging, kind, method, true)));
    }
    cells.push_back(fmt::format("{:.3f}", of_middle.best_ratio()));
    table.add(cells);
  }
  return fmt::format(kIntroduction, fmt::arg("frames", field_study::kSequenceFrames),
                     fmt::arg("noise", kTypicalNoise)) +
         table.text();
}

}  // namespace pillarfield::report
