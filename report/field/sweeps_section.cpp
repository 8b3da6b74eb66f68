// The error against sweeps, and against time.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Sweeps and time

The sweeps of the relaxation are the knob of speed against error. Below: the ratio of the RMS errors by sweeps (noise 0.5, nothing said), and what they cost on {device}: the time
over that of the direct solve of the same frame, in which {share:.0f} % of the pillars are in contact, both measured in turns, 40 rounds. Without the evidence of shape it is {slip:.2f}.

)";

constexpr const char* kPicture = R"(
![Error against time](pictures/field/error_and_time.png)

*The ratio of the RMS errors to the paper's midpoint against time over that of the direct solve. The points of a line are the sweeps of the table.*
)";

constexpr const char* kScript = R"(
set logscale xy
set xtics (1, 1.5, 2, 3, 5, 10, 20, 50, 100)
set xlabel 'time (direct solve: 1)'
set ylabel 'RMS error in region 3 (midpoint: 1)'
set ytics (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2)
set grid ytics linecolor '#dddddd'
set xrange [{:.2f} : {:.1f}]
set yrange [{:.3f} : 2]
set key outside right top Left reverse
)";

Pooled at_sweeps(const std::vector<SceneResult>& results, const Kind& kind, std::size_t index) {
  return pool(
      results, [&](const SceneResult& result) { return kind.holds(result.scene); },
      [&](const SceneResult& result) { return result.by_sweeps.at(index); });
}

std::string sweeps_table(const FieldContext& context) {
  std::vector<std::string> header = {"sweeps"};
  for (const int sweeps : kSweeps) header.push_back(fmt::format("{}", sweeps));
  Table table("l" + std::string(kSweeps.size(), 'r'), header);
  for (const Kind& kind : kinds()) {
    if (kind.name == "press, any") continue;
    std::vector<std::string> cells = {kind.name};
    for (std::size_t i = 0; i < kSweeps.size(); ++i) {
      cells.push_back(ratio_text(at_sweeps(context.judging, kind, i)));
    }
    table.add(cells);
  }
  std::vector<std::string> times = {"time, direct = 1"};
  for (const double time : context.times.over_direct) times.push_back(fmt::format("{:.2f}", time));
  table.add(times);
  return table.text();
}

void draw_chart(const FieldContext& context) {
  std::string data = "$points << END\n";
  std::string plot;
  int line = 0;
  double least = 0.1;
  for (const Kind& kind : kinds()) {
    if (kind.name == "press, any") continue;
    for (std::size_t i = 0; i < kSweeps.size(); ++i) {
      const Pooled pooled = at_sweeps(context.judging, kind, i);
      if (pooled.ratio() > 0) least = std::min(least, pooled.ratio());
      data += fmt::format("{:.4f} {:.4f}\n", context.times.over_direct.at(i), pooled.ratio());
    }
    data += "\n\n";
    plot += fmt::format("{} index {} using 1:2 with linespoints linetype {} dashtype {} title '{}'",
                        line == 0 ? "plot $points" : ", ''", line, line % 8 + 1, line / 8 + 1,
                        kind.name);
    ++line;
  }
  const auto& times = context.times.over_direct;
  const auto [shortest, longest] = std::minmax_element(times.begin(), times.end());
  gnuplot::draw(
      context.docs / "pictures/field/error_and_time",
      data + "END\n" +
          fmt::format(kScript, 0.9 * *shortest, std::max(2.0, 1.1 * *longest), 0.8 * least) + plot +
          "\n",
      {860, 420});
}

}  // namespace

std::string sweeps_section(const FieldContext& context) {
  draw_chart(context);
  return fmt::format(kIntroduction, fmt::arg("device", context.times.device),
                     fmt::arg("share", 100 * context.times.contact_share),
                     fmt::arg("slip", context.times.without_shape)) +
         sweeps_table(context) + kPicture;
}

}  // namespace pillarfield::report
