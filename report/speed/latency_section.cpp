// How long single frames take, alone and from a sensor that does not wait.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "pillarfield/error.h"
#include "report/speed/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

constexpr const char* kSpreadRow = "spread/6241";
constexpr double kBinsPerDecade = 10;

constexpr const char* kSingle = R"(## Latency

From submit to result, one frame in flight, each frame timed by itself, by turns with a kernel that does nothing.

)";

constexpr const char* kPicture = R"(
![How the times of single frames are spread](pictures/performance/latency.png)

*{left}ingle frames of 79 × 79 pillars, 10 × 10 cm, and empty launches: {times} of each.{right}*
)";
constexpr const char* kRight = " Right: the frames of the live run, below.";

constexpr const char* kLiveTitle = R"(
### A square metre, live

`pillarfield live` ([live.md](live.md)) gives the frames of a scene to the solver at the rate of a sensor. Latency runs from when a frame was
*due*, so that a frame that has to wait bears it.

)";

constexpr const char* kNoLive = R"(
### A square metre, live

Unmeasured: this run had no `pillarfield live`.
)";

/// Shares of the times by the lower end of their bin in microseconds, of the counters
/// "<who>_from_<end>us".
std::map<double, double> spread_of(const BenchRun& bench, const std::string& who) {
  const std::string beginning = who + "_from_";
  std::map<double, double> spread;
  for (const auto& [name, share] : bench.counters(kSpreadRow)) {
    if (!name.starts_with(beginning)) continue;
    spread[std::stod(name.substr(beginning.size()))] = share;
  }
  if (spread.empty()) {
    throw Error(kSpreadRow, fmt::format("the row has no times of '{}'", who),
                "measure anew with ./dev report speed");
  }
  return spread;
}

double most_of(const std::map<double, double>& spread) {
  double most = 0;
  for (const auto& [from_us, share] : spread) most = std::max(most, share);
  return most;
}

/// Boxes: their place, their ends, their height.
std::string boxes_of(const std::map<double, double>& spread) {
  std::string text;
  const double width = std::pow(10, 1 / kBinsPerDecade);
  for (const auto& [from_us, share] : spread) {
    text += fmt::format("{} {} {} {}\n", from_us * std::sqrt(width), from_us, from_us * width,
                        100 * share);
  }
  return text;
}

std::string boxes_of(const LiveRun& live) {
  std::string text;
  for (const LiveRun::Bin& bin : live.histogram) {
    if (bin.frames == 0) continue;
    text += fmt::format("{} {} {} {}\n", std::sqrt(bin.from_ms * bin.to_ms), bin.from_ms, bin.to_ms,
                        bin.frames);
  }
  return text;
}

constexpr const char* kSingleScript = R"(
set logscale x
set xlabel 'time of one frame (µs)'
set ylabel 'share of the frames (%)'
set yrange [0 : 1.35 * most_share]
set key top right
set style fill transparent solid 0.55 noborder
plot $empty using 1:4:2:3:(0):4 with boxxyerror linecolor '#999999' title 'empty launch', \
     $solve using 1:4:2:3:(0):4 with boxxyerror linetype 6 title '79 × 79 pillars'
)";

constexpr const char* kLiveScript = R"(
set logscale xy
set xlabel 'latency (ms)'
set xtics (0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
set ylabel 'frames'
set xrange [least_ms : most_ms]
set yrange [0.7 : *]
set style fill solid 0.9 noborder
set arrow 1 from first deadline, graph 0 to first deadline, graph 1.03 nohead linetype 7 dashtype 2
set label 1 'deadline' at first deadline, graph 1.08 center textcolor '#D55E00'
plot $live using 1:4:2:3:(0.7):4 with boxxyerror linetype 6
unset label 1
unset arrow 1
)";

void draw(const std::filesystem::path& stem, const BenchRun& bench,
          const std::optional<LiveRun>& live) {
  const auto empty = spread_of(bench, "empty");
  const auto solve = spread_of(bench, "solve");
  std::string script =
      fmt::format("$empty << END\n{}END\n$solve << END\n{}END\nmost_share = {}\n", boxes_of(empty),
                  boxes_of(solve), 100 * std::max(most_of(empty), most_of(solve)));
  if (!live || live->histogram.empty()) {
    return gnuplot::draw(stem, script + "set margins 9, 3, 3.5, 2.5\n" + kSingleScript, {640, 400});
  }
  constexpr double kAside = 1.5;
  script += fmt::format("$live << END\n{}END\ndeadline = {}\nleast_ms = {}\nmost_ms = {}\n",
                        boxes_of(*live), live->deadline_ms,
                        std::min(live->histogram.front().from_ms, live->deadline_ms) / kAside,
                        std::max(live->histogram.back().to_ms, live->deadline_ms) * kAside);
  script += "set multiplot layout 1,2 margins 0.095, 0.975, 0.2, 0.88 spacing 0.12\n";
  gnuplot::draw(stem, script + kSingleScript + kLiveScript + "unset multiplot\n", {960, 400});
}

std::string single_table(const BenchRun& bench) {
  Table table("rrrr", {"Pillars", "median, µs", "99 %, µs", "median over an empty launch"});
  for (const std::string& row : bench.rows_of("latency")) {
    table.add({fmt::format("{:.0f}", bench.value(row, "pillars")),
               fmt::format("{:.1f}", bench.value(row, "median_us")),
               fmt::format("{:.1f}", bench.value(row, "p99_us")),
               fmt::format("{:.2f}", bench.value(row, "of_empty_launch"))});
  }
  return table.text();
}

std::string milliseconds(const std::optional<double>& latency) {
  return latency ? fmt::format("{:.3f}", *latency) : "never";
}

std::string live_table(const LiveRun& live) {
  Table table("lr", {fmt::format("`{}`, {} pillars, {:g} Hz for {:.1f} s", live.source,
                                 live.pillars, live.rate_hz, live.seconds),
                     ""});
  table.add({"frames scheduled", fmt::format("{}", live.scheduled)});
  table.add({fmt::format("missed: later than {:g} ms", live.deadline_ms),
             fmt::format("{}", live.missed)});
  table.add({"dropped", fmt::format("{}", live.dropped)});
  table.add({"latency that half of them did not exceed, ms", milliseconds(live.p50_ms)});
  table.add({"99 %", milliseconds(live.p99_ms)});
  table.add({"99.9 %", milliseconds(live.p99_9_ms)});
  table.add({"longest", milliseconds(live.longest_ms)});
  table.add({"cores used", fmt::format("{:.2f}", live.cpu_cores)});
  table.add({"in contact", fmt::format("{:.1f} %", 100 * live.contact_share)});
  return table.text();
}

}  // namespace

std::string latency_section(const SpeedContext& context) {
  const BenchRun& bench = context.run.bench;
  const std::optional<LiveRun>& live = context.run.live;
  draw(context.docs / "pictures/performance/latency", bench, live);
  return kSingle + single_table(bench) +
         fmt::format(kPicture, fmt::arg("times", bench.label(kSpreadRow)),
                     fmt::arg("left", live ? "Left: s" : "S"),
                     fmt::arg("right", live ? kRight : "")) +
         (live ? kLiveTitle + live_table(*live) : kNoLive);
}

}  // namespace pillarfield::report
