// The error against sweeps, and against time.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

constexpr const char* kIntroduction = R"(## Sweeps and time

The sweeps of the relaxation are the knob of speed against error. Below: the ratio of the RMS errors by sweeps (noise 0.5, nothing said), and what they cost on {device}: the processor time of
all threads over that of the direct solve of the same frame, in which {share:.0f} % of the pillars are in contact, and the same of time, which depends on where threads come to lie; both measured in turns, 40 rounds. Without the evidence of shape it is {slip:.2f} of processor time.

)";

constexpr const char* kPicture = R"(
![Error against time](pictures/field/error_and_time.png)

*The ratio of the RMS errors to the paper's midpoint against processor time over that of the direct solve. Colours are bodies, marks are motions; the points of a line are the sweeps of the table.*
)";

constexpr const char* kScript = R"(
set logscale xy
set xtics (1, 1.5, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100)
set xlabel 'processor time (direct solve: 1)'
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
  std::vector<std::string> processor = {"processor time, direct = 1"};
  std::vector<std::string> time = {"time, direct = 1"};
  for (const OverDirect& cost : context.times.over_direct) {
    processor.push_back(fmt::format("{:.2f}", cost.processor));
    time.push_back(fmt::format("{:.1f}", cost.time));
  }
  table.add(processor);
  table.add(time);
  return table.text();
}

/// Where a name stands in a list, which it joins where it is new.
std::size_t place_in(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  const auto place = static_cast<std::size_t>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return place;
}

/// How lines of kinds are told apart, of which there are more than colours: "rounded, slide" has
/// the colour of what is rounded and the mark of what slides.
class LineStyles {
 public:
  std::string of(const Kind& kind) {
    const std::size_t comma = kind.name.find(", ");
    const std::size_t body = place_in(bodies_, kind.name.substr(0, comma));
    const std::size_t motion = place_in(motions_, kind.name.substr(comma + 2));
    return fmt::format("linetype {} pointtype {}", kColours.at(body), kMarks.at(motion));
  }

 private:
  // Hollow marks, so that one on another shows both.
  static constexpr std::array kColours = {1, 4, 7, 6, 2, 8};  // of the style of all our charts
  static constexpr std::array kMarks = {6, 4, 8, 12, 10, 14};

  std::vector<std::string> bodies_;
  std::vector<std::string> motions_;
};

void draw_chart(const FieldContext& context) {
  std::string data = "$points << END\n";
  std::string plot;
  int line = 0;
  LineStyles styles;
  double least = 0.1;
  for (const Kind& kind : kinds()) {
    if (kind.name == "press, any") continue;
    for (std::size_t i = 0; i < kSweeps.size(); ++i) {
      const Pooled pooled = at_sweeps(context.judging, kind, i);
      if (pooled.ratio() > 0) least = std::min(least, pooled.ratio());
      data +=
          fmt::format("{:.4f} {:.4f}\n", context.times.over_direct.at(i).processor, pooled.ratio());
    }
    data += "\n\n";
    plot += fmt::format("{} index {} using 1:2 with linespoints {} title '{}'",
                        line == 0 ? "plot $points" : ", ''", line, styles.of(kind), kind.name);
    ++line;
  }
  const auto [shortest, longest] =
      std::ranges::minmax_element(context.times.over_direct, {}, &OverDirect::processor);
  gnuplot::draw(context.docs / "pictures/field/error_and_time",
                data + "END\n" +
                    fmt::format(kScript, 0.9 * shortest->processor,
                                std::max(2.0, 1.1 * longest->processor), 0.8 * least) +
                    plot + "\n",
                {860, 420});
}

}  // namespace

std::string sweeps_section(const FieldContext& context) {
  draw_chart(context);
  return fmt::format(kIntroduction, fmt::arg("device", context.times.device),
                     fmt::arg("share", 100 * context.times.contact_share),
                     fmt::arg("slip", context.times.without_shape.processor)) +
         sweeps_table(context) + kPicture;
}

}  // namespace pillarfield::report
