// Every judging contact.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Scene by scene

Every judging contact at noise 0.5, nothing said: the ambiguous share of its loaded pillars and the RMS error of the paper's midpoint in counts, each at a friction of 1.6 (1.45 where there is no shear), and the
ratio of field to midpoint by friction. Ratios of fewer than {enough} pillars stand in brackets.

)";

const SceneResult* find(const std::vector<SceneResult>& results, const std::string& contact,
                        double friction) {
  const auto found = std::find_if(results.begin(), results.end(), [&](const SceneResult& result) {
    return result.scene.contact_name == contact && result.scene.friction == friction &&
           result.scene.noise_counts == kTypicalNoise;
  });
  return found == results.end() ? nullptr : &*found;
}

std::string ratio_cell(const SceneResult* result) {
  if (result == nullptr || result->theta.open == 0) return "–";
  return fmt::format(fmt::runtime(result->counts() ? "{:.3f}" : "({:.2f})"), result->ratio());
}

std::vector<std::string> cells_of(const std::vector<SceneResult>& results,
                                  const std::string& contact,
                                  const std::vector<double>& frictions) {
  const SceneResult* typical = find(results, contact, 1.6);
  if (typical == nullptr) typical = find(results, contact, frictions.front());
  if (typical == nullptr) return {};
  std::vector<std::string> cells = {contact,
                                    fmt::format("{:.1f}", 100 * (1 - typical->settled_share())),
                                    fmt::format("{:.1f}", typical->theta.rms_counts())};
  for (const double friction : frictions) {
    cells.push_back(ratio_cell(find(results, contact, friction)));
  }
  return cells;
}

}  // namespace

std::string contacts_section(const FieldContext& context) {
  const std::vector<double> frictions = {1.45, 1.6, 2, 2.5};
  Table table("lrrrrrr", {"", "ambiguous, %", "θ middle", "µ 1.45", "1.6", "2", "2.5"});
  std::string last;
  for (const SceneResult& result : context.judging) {
    if (result.scene.contact_name == last) continue;
    last = result.scene.contact_name;
    if (result.scene.friction < frictions.front()) continue;
    const auto cells = cells_of(context.judging, last, frictions);
    if (!cells.empty()) table.add(cells);
  }
  return fmt::format(kIntroduction, fmt::arg("enough", kEnoughPillars)) + table.text();
}

}  // namespace pillarfield::report
