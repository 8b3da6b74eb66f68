#include "report/field/scene_lines.h"

#include <fmt/format.h>

#include <cstddef>
#include <map>

namespace pillarfield::report {
namespace {

using field_study::Method;
using field_study::Observed;
using field_study::Scene;
using field_study::Score;

struct Line {
  Score middle;
  Score theta;
  Score best;
  Score field;
};

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

double ratio_of(const Line& line) {
  return line.theta.squares > 0 ? line.field.rms_counts() / line.theta.rms_counts() : 0;
}

Line line_of(const Scene& scene, int sweeps) {
  const Observed observed(scene);
  Method method = field_study::methods().front();
  method.evidence.sweeps = sweeps;
  return {observed.score(observed.direct()), observed.score(observed.theta_midpoint()),
          observed.score(observed.nearest()),
          observed.score(*field_study::solve(scene, observed, method))};
}

/// The scenes of one family and motion.
struct Kind {
  Line sum;
  double worst = 0;
  std::string worst_name;
  double least_coverage = 1;
  std::size_t scenes = 0;
};

void add(Kind& kind, const Scene& scene, const Line& line) {
  constexpr std::size_t kEnoughPillars = 30;  // for a ratio and a share to mean something
  kind.sum.middle += line.middle;
  kind.sum.theta += line.theta;
  kind.sum.best += line.best;
  kind.sum.field += line.field;
  ++kind.scenes;
  if (line.field.open < kEnoughPillars) return;
  kind.least_coverage = std::min(kind.least_coverage, line.field.coverage());
  if (ratio_of(line) <= kind.worst) return;
  kind.worst = ratio_of(line);
  kind.worst_name = scene.name();
}

std::string text_of(const std::string& name, const Line& line) {
  const Score& field = line.field;
  return fmt::format(
      "{:62} {:6} {:5.1f} {:6.1f} {:7.2f} {:7.2f} {:7.2f} {:7.2f} {:6.3f} {:6.1f} {:6.1f}{}\n",
      name, field.open, share(field.open, field.loaded), share(field.resolved, field.open),
      line.middle.rms_counts(), line.theta.rms_counts(), line.best.rms_counts(), field.rms_counts(),
      ratio_of(line), 100 * field.coverage(), share(field.resolved_covered, field.resolved),
      field.touched == 0 ? "" : fmt::format("  TOUCHED {}", field.touched));
}

}  // namespace

std::string scene_lines(const std::vector<Scene>& scenes, int sweeps) {
  std::vector<Line> lines(scenes.size());
  field_study::for_each_index(scenes.size(),
                              [&](std::size_t i) { lines[i] = line_of(scenes[i], sweeps); });
  const std::string header = fmt::format(
      "{:62} {:>6} {:>5} {:>6} {:>7} {:>7} {:>7} {:>7} {:>6} {:>6} {:>6}\n", "", "open", "%open",
      "%solvd", "middle", "theta", "best", "field", "ratio", "%covrd", "%c.res");
  std::string text = header;
  std::map<std::string, Kind> kinds;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    text += text_of(scenes[i].name(), lines[i]);
    add(kinds[fmt::format("{} / {}", name_of(scenes[i].family()), name_of(scenes[i].motion()))],
        scenes[i], lines[i]);
  }
  text += "\n" + header;
  for (const auto& [name, kind] : kinds) {
    text += text_of(fmt::format("{} ({})", name, kind.scenes), kind.sum);
    text += fmt::format("    worst ratio {:.3f}: {}; least coverage {:.1f} %\n", kind.worst,
                        kind.worst_name, 100 * kind.least_coverage);
  }
  return text;
}

}  // namespace pillarfield::report
