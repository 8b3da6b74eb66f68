// Small forces behind a dead zone, before and after it is known.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "report/section.h"
#include "testbed/gnuplot.h"
#include "testbed/small_forces.h"

namespace pillarfield::report {
namespace {

using testbed::SmallForceErrors;
using testbed::SmallForcePoint;

constexpr const char* kScript = R"(
set multiplot layout 1,2 margins 0.105, 0.975, 0.2, 0.96 spacing 0.14
set logscale x
set xrange [0.3 : 100]
set xtics (0.3, 1, 3, 10, 30, 100)
set xlabel 'force over dead zone, F k / z'
set key top right
set yrange [0 : 100]
set ytics 20
set ylabel 'share of the directions (%)'
plot $points using 1:2 with lines linetype 1 linewidth 1.5 dashtype 3 title 'unfelt', \
     '' using 1:3 with linespoints linetype 1 pointtype 7 pointsize 0.5 title 'wrong region', \
     '' using 1:4 with linespoints linetype 7 pointtype 5 pointsize 0.6 title 'unflagged, before', \
     '' using 1:5 with linespoints linetype 6 pointtype 7 pointsize 0.7 title 'unflagged, after'
set logscale y
set key bottom left Left reverse
set yrange [0.0001 : 1]
set ytics ('0.0001' 0.0001, '0.001' 0.001, '0.01' 0.01, '0.1' 0.1, '1' 1)
set ylabel 'RMS error of the force, over F'
plot $points using 1:8 with lines linetype 2 dashtype 2 title 'all: paper', \
     '' using 1:9 with lines linetype 3 dashtype 2 title 'all: direct, after', \
     '' using 1:6 with linespoints linetype 7 pointtype 5 pointsize 0.6 \
        title '3 or 4 usable, before', \
     '' using 1:7 with linespoints linetype 6 pointtype 7 pointsize 0.7 \
        title '3 or 4 usable, after'
unset multiplot
)";

void draw(const std::filesystem::path& stem, const std::vector<SmallForcePoint>& points) {
  std::string data = "$points << END\n";
  for (const auto& [load, paper, naive, direct] : points) {
    data += fmt::format("{} {} {} {} {} {} {} {} {}\n", load, 100 * direct.unfelt,
                        100 * direct.wrong_region, 100 * naive.unflagged, 100 * direct.unflagged,
                        naive.determined, direct.determined, paper.force, direct.force);
  }
  gnuplot::draw(stem, data + "END\n" + kScript, {960, 400});
}

/// By how much the dead zone, once known, lessens the error of forces of this load.
double gain_at(const std::vector<SmallForcePoint>& points, double load) {
  const auto point = std::find_if(points.begin(), points.end(),
                                  [&](const SmallForcePoint& p) { return p.load == load; });
  return point->naive.determined / point->direct.determined;
}

std::string percent(double share) { return fmt::format("{:.1f} %", 100 * share); }

std::string shares_table(const std::vector<SmallForcePoint>& points) {
  std::string table =
      "| F k / z | unfelt | wrong region | unflagged before | unflagged after | truth held before "
      "| "
      "truth held after |\n|--:|--:|--:|--:|--:|--:|--:|\n";
  for (const auto& [load, paper, naive, direct] : points) {
    table += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", load, percent(direct.unfelt),
                         percent(direct.wrong_region), percent(naive.unflagged),
                         percent(direct.unflagged), percent(naive.held), percent(direct.held));
  }
  return table;
}

/// "paper / direct before / direct after".
std::string three(const SmallForcePoint& point, double SmallForceErrors::*error) {
  if (std::isnan(point.direct.*error)) return "none";
  return fmt::format("{:.3f} / {:.3f} / {:.3f}", point.paper.*error, point.naive.*error,
                     point.direct.*error);
}

std::string errors_table(const std::vector<SmallForcePoint>& points) {
  std::string table =
      "| F k / z | force, three or more usable | force | θ, rad | φ, rad "
      "|\n|--:|--:|--:|--:|--:|\n";
  for (const SmallForcePoint& point : points) {
    table += fmt::format(
        "| {} | {} | {} | {} | {} |\n", point.load, three(point, &SmallForceErrors::determined),
        three(point, &SmallForceErrors::force), three(point, &SmallForceErrors::theta_rad),
        three(point, &SmallForceErrors::phi_rad));
  }
  return table;
}

constexpr const char* kIntroduction = R"(## Small forces

A sensel that swallows its first z counts is silent under small forces, and what it reads of large ones is
z short. The paper met this in region 1 of its Table II and left it to "additional checks". Here forces of one
magnitude come from {directions} directions, evenly over the hemisphere, to a sensor with z = {z} counts, noise of
{noise} counts and a threshold of {threshold}. *Before*, the solve is not told of z; *after*, it is, as part of the
calibration. The paper's equations are never told.

)";

constexpr const char* kReading = R"(
*Unfelt*: no sensel answers; such forces count as zero. *Wrong region*: other than in the ideal model, by the usable
bits, which know no better than the sensels; knowing z cannot change them, but it lets the status say where the region is
open (ambiguous). *Unflagged*: wrong, and no bit says so. *Truth held*: θ, φ and magnitude lie between the stated ends,
three standard deviations of noise allowed. Errors are RMS: paper / direct before / direct after; of the force as a share of F;
φ is weighted with sin θ.

Once z is known, no felt force is given a wrong region without a warning, and the ends hold the truth. Where three or
four sensels are usable, what is left of the force's error is noise: {gain:.0f} times less at F k = 10 z. Elsewhere the
force is ambiguous, known or not. Over all directions the floor is region 3, a third of the hemisphere (as are regions 1
and 2), where two readings leave one number open. There the paper's choice, half way in θ, and the segment point have
RMS errors of {paper:.3f} and {direct:.3f} of F under large forces from all directions alike; but directions near the skin take a friction
that hardly any contact has, and the segment point is chosen for frictions of 1.2 to 3.
)";

}  // namespace

std::string small_forces_section(const Context& context) {
  const std::vector<SmallForcePoint> points = testbed::small_forces();
  draw(context.docs / "pictures/accuracy/small_forces", points);
  return fmt::format(kIntroduction, fmt::arg("directions", testbed::kStudyDirections),
                     fmt::arg("z", testbed::kStudyDeadZoneCounts),
                     fmt::arg("noise", testbed::kStudyNoiseCounts),
                     fmt::arg("threshold", testbed::kStudyThresholdCounts)) +
         "![Shares and errors against the force](pictures/accuracy/small_forces.png)\n\n" +
         shares_table(points) + "\n" + errors_table(points) +
         fmt::format(kReading, fmt::arg("gain", gain_at(points, 10)),
                     fmt::arg("paper", points.back().paper.force),
                     fmt::arg("direct", points.back().direct.force));
}

}  // namespace pillarfield::report
