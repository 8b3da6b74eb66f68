// The error of region 3 by kind of contact, noise and friction.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <vector>

#include "core/quantile.h"
#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Kinds of contact

The judging scenes, nothing said by them; errors in counts (k times newtons), all pillars of a kind taken together. "Middle" is that of the segment, `direct` at a segment point of 0.5; "θ middle"
the paper's midpoint; "noise alone" the nearest to the truth of all forces that explain the readings. The ratio is field over θ middle; its median and its worst are those of
scenes with {enough} ambiguous pillars or more.

)";

constexpr const char* kByNoise = R"(
The ratio by noise, in counts a reading, and by friction. At a friction of 1 hardly a pillar is ambiguous: two adjacent sensels
lift only where shear exceeds √2 times the normal force, or more, by its direction.

)";

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

std::vector<double> ratios_of(const std::vector<SceneResult>& results, const Kind& kind) {
  std::vector<double> ratios;
  for (const SceneResult& result : results) {
    if (result.counts() && kind.holds(result.scene)) ratios.push_back(result.ratio());
  }
  return ratios;
}

std::string kinds_table(const std::vector<SceneResult>& results) {
  Table table("lrrrrrrrrrr", {"", "ambiguous, %", "resolved, %", "middle", "θ middle",
                              "noise alone", "field", "ratio", "median", "worst", "scenes"});
  for (const Kind& kind : kinds()) {
    const Pooled pooled = pool_method(results, kind, 0);
    std::vector<double> ratios = ratios_of(results, kind);
    const bool any = !ratios.empty();
    table.add({kind.name, fmt::format("{:.1f}", percent(pooled.solved.open, pooled.solved.loaded)),
               fmt::format("{:.1f}", percent(pooled.solved.resolved, pooled.solved.open)),
               fmt::format("{:.2f}", pooled.middle.rms_counts()),
               fmt::format("{:.2f}", pooled.theta.rms_counts()),
               fmt::format("{:.2f}", pooled.best.rms_counts()),
               fmt::format("{:.2f}", pooled.solved.rms_counts()), ratio_text(pooled),
               any ? fmt::format("{:.3f}", median(ratios)) : "–",
               any ? fmt::format("{:.3f}", *std::max_element(ratios.begin(), ratios.end())) : "–",
               fmt::format("{}", pooled.scenes)});
  }
  return table.text();
}

using Value = double (*)(const field_study::Scene&);

std::vector<double> values_in(const std::vector<SceneResult>& results, Value value) {
  std::set<double> values;
  for (const SceneResult& result : results) values.insert(value(result.scene));
  return {values.begin(), values.end()};
}

/// A column of ratios for each value of `value`.
void append_ratios(const std::vector<SceneResult>& results, const Kind& kind, Value value,
                   std::vector<std::string>& cells) {
  for (const double wanted : values_in(results, value)) {
    cells.push_back(ratio_text(pool(
        results,
        [&](const SceneResult& result) {
          return kind.holds(result.scene) && value(result.scene) == wanted;
        },
        [](const SceneResult& result) { return result.by_method.front(); })));
  }
}

double noise_of(const field_study::Scene& scene) { return scene.noise_counts; }
double friction_of(const field_study::Scene& scene) { return scene.friction; }

std::string by_noise_and_friction(const std::vector<SceneResult>& results) {
  std::vector<std::string> header = {""};
  for (const double noise : values_in(results, noise_of)) {
    header.push_back(fmt::format("noise {:g}", noise));
  }
  for (const double friction : values_in(results, friction_of)) {
    header.push_back(fmt::format("µ {:g}", friction));
  }
  Table table("l" + std::string(header.size() - 1, 'r'), header);
  for (const Kind& kind : kinds()) {
    if (kind.name == "press, any") continue;
    std::vector<std::string> cells = {kind.name};
    append_ratios(results, kind, noise_of, cells);
    append_ratios(results, kind, friction_of, cells);
    table.add(cells);
  }
  return table.text();
}

}  // namespace

std::string kinds_section(const FieldContext& context) {
  return fmt::format(kIntroduction, fmt::arg("enough", kEnoughPillars)) +
         kinds_table(context.judging) + kByNoise + by_noise_and_friction(context.judging);
}

}  // namespace pillarfield::report
