// What was measured on, and one history in a picture.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

using field_study::Indenter;
using field_study::Loading;
using field_study::Recording;

constexpr const char* kIntroduction = R"(## Recordings

**Histories**: {} recordings of 8 to 12 frames, listed in `tests/core/field_study_histories.cpp`. The simulator's boundary-element solver ([derivation](derivations/half_space.md)) finds pressure and shear of a rigid body on an elastic half-space, so that each frame depends on those before. Readings have 8 bits, noise of 0.5 counts and a threshold of 2; the largest
reading of a recording is 150 counts. Contact radii are 3, 5, 8, 12, 16 and 22 pillars (of a circle of the same area). No parameter of any estimator was chosen on them.

)";

constexpr const char* kPicture = R"(
![A history](pictures/field/history.png)

*{}: left, the mean normal force of the pillars of region 3 in each frame; right, some of these pillars in the last frame, with their stated 95 %.*
)";

constexpr const char* kScript = R"(
set multiplot layout 1,2
set grid linecolor '#dddddd'
set xlabel 'frame'
set ylabel 'mean normal force, counts'
set yrange [0:*]
set key bottom right Left reverse
set xtics 2
plot $means using 1:2 with linespoints linetype 1 linewidth 2 pointtype 7 pointsize 0.6 title 'truth', '' using 1:3 with linespoints linetype 6 pointtype 7 pointsize 0.6 title 'contact', '' using 1:4 with linespoints linetype 3 pointtype 7 pointsize 0.6 title 'direct', '' using 1:5 with linespoints linetype 7 pointtype 7 pointsize 0.6 title 'paper'
set key top left Left reverse
set xtics auto
set xlabel 'true normal force, counts'
set ylabel 'estimated normal force, counts'
set xrange [0:*]
plot $pillars using 1:4 with points linetype 7 pointtype 7 pointsize 0.4 title 'paper', '' using 1:($2-$3):(0):(2*$3) with vectors nohead linetype 6 notitle, '' using 1:2 with points linetype 6 pointtype 7 pointsize 0.4 title 'contact', x with lines linetype 1 notitle
unset multiplot
)";

/// Pillars that are drawn: error bars of more hide each other.
constexpr std::size_t kMostBars = 50;

/// A finger that is dragged until it slides.
bool is_shown(const field_study::History& history) {
  return history.indenter == Indenter::fingertip && history.loading == Loading::slide &&
         history.friction == 1.6;
}

std::string draw_history(const FieldContext& context) {
  const auto& all = field_study::histories();
  const Recording recording =
      field_study::record(*std::find_if(all.begin(), all.end(), is_shown), context.scenes);
  const field_study::Evaluation evaluation(recording);
  const double counts = recording.plan.skin.counts_per_newton;
  std::array<std::vector<ForceField>, 3> solved;
  constexpr std::array kMethods = {kContact, kDirect, kPaper};
  for (std::size_t i = 0; i < kMethods.size(); ++i) {
    SolverPlan plan = recording.plan;
    methods()[kMethods[i]].set(plan, recording.friction);
    solved[i] = field_study::solve(recording, plan);
  }
  const auto mean = [&](const ForceField& field, const std::vector<std::size_t>& pillars) {
    double sum = 0;
    for (const std::size_t i : pillars) sum += field.normal[i];
    return counts * sum / static_cast<double>(pillars.size());
  };
  std::string data = "$means << END\n";
  for (std::size_t frame = 0; frame < recording.frames.size(); ++frame) {
    const auto& open = evaluation.open(frame);
    if (open.size() < kEnoughPillars / 2) continue;
    data += fmt::format("{} {:.3f} {:.3f} {:.3f} {:.3f}\n", frame,
                        mean(recording.truth[frame], open), mean(solved[0][frame], open),
                        mean(solved[1][frame], open), mean(solved[2][frame], open));
  }
  data += "END\n$pillars << END\n";
  const ForceField& contact = solved[0].back();
  const auto& last = evaluation.open(recording.frames.size() - 1);
  for (std::size_t k = 0; k < last.size(); k += 1 + last.size() / kMostBars) {
    const std::size_t i = last[k];
    data += fmt::format("{:.3f} {:.3f} {:.3f} {:.3f}\n", counts * recording.truth.back().normal[i],
                        counts * contact.normal[i],
                        1.96 * counts * contact.uncertainty[Uncertainty::normal][i],
                        counts * solved[2].back().normal[i]);
  }
  gnuplot::draw(context.docs / "pictures/field/history", data + "END\n" + kScript, {880, 380});
  return recording.name;
}

std::string histories_table(const std::vector<HistoryResult>& results) {
  std::vector<std::string> header = {"recordings"};
  for (int i = 0; i < field_study::kLoadings; ++i) {
    header.emplace_back(name_of(static_cast<Loading>(i)));
  }
  Table table("l" + std::string(field_study::kLoadings, 'r'), header);
  for (int i = 0; i < field_study::kIndenters; ++i) {
    const auto indenter = static_cast<Indenter>(i);
    std::vector<std::string> cells = {name_of(indenter)};
    for (int j = 0; j < field_study::kLoadings; ++j) {
      cells.push_back(
          fmt::format("{}", std::count_if(results.begin(), results.end(), [&](const auto& result) {
                        return result.history.indenter == indenter &&
                               result.history.loading == static_cast<Loading>(j);
                      })));
    }
    table.add(cells);
  }
  return table.text();
}

}  // namespace

std::string recordings_section(const FieldContext& context) {
  return fmt::format(fmt::runtime(kIntroduction), context.histories.size()) +
         histories_table(context.histories) +
         fmt::format(fmt::runtime(kPicture), draw_history(context));
}

}  // namespace pillarfield::report
