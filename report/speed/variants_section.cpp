// The one chart: what each way to solve costs, and how near the truth it comes.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <string_view>
#include <vector>

#include "bench/noisy_frame_store.h"
#include "bench/variants.h"
#include "report/speed/force_error.h"
#include "report/speed/pareto.h"
#include "report/speed/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

using bench::SolveVariant;

constexpr std::size_t kFrames = 1;  ///< of a square metre: errors to a thousandth
constexpr double kResolution = 0.003;

constexpr const char* kIntroduction = R"(## Error against time

Every way to solve: by estimator, arithmetic, type of sensel, and stages. The frames that are timed are those of a
sensor with normal noise of {noise} counts and a threshold of {threshold} counts, whose every pillar is pressed with a known force of 15 to 150 counts from
any direction. `u8` sensels round to whole counts, `u16` ones count sixteen times finer and round to that, `f32` ones do not round. With `calibration` and `all`
each sensel has a tare, a gain (± 10 %), a dead zone, or is dead (3 in 1000), and the solve knows them.

- **Time** is over that of the bare copy, 17 bytes per pillar of uint8 sensels: what no bare solve can be faster than.
- **Error over the bound** is the RMS of |solved − true| over the Cramér–Rao bound of the pillar ([derivation](derivations/bound.md)), for the noise that its readings really
  have: with the converter's 1/12 count² and as the gains leave it. It is of regions 1 and 2, where there is a bound, and of
  pillars with no dead or saturated sensel and no reading within five standard deviations of the threshold: {pillars} pillars, so that the third digit is doubtful by one.
- **Counts** are those of uint8 sensels. *All regions* has the ambiguous forces of regions 3 and 4 too, of which a part stays unknown whoever solves;
  their share is the last column.

`float` is the OpenCL kernels. `double` is a C++ loop over the same `kernels/pillar`, compiled for this processor and for each set of stages, on all threads; it
stores its results as float32. That loop is the only place where fields are solved in double.

![Error over the bound against time over the bare copy](pictures/performance/error_and_time.png)

*Each way to solve, by type of sensel. Ringed: the Pareto front, than which nothing is both as fast and more exact (by 0.3 % or more).*

)";

/// One way to solve, measured.
struct Outcome {
  SolveVariant variant;
  double time_ns = 0;  ///< per pillar
  double of_ceiling = 0;
  double over_bare_copy = 0;
  ForceError error;
  bool on_front = false;
};

std::vector<Outcome> measure(const SpeedContext& context) {
  bench::NoisyFrameStore store(bench::kSquareMetre, kFrames);
  std::vector<Outcome> outcomes;
  for (const SolveVariant& variant : bench::solve_variants()) {
    const std::string row = "variant/" + name_of(variant);
    const BenchRun& run = context.run.bench;
    Outcome outcome;
    outcome.variant = variant;
    outcome.time_ns = run.value(row, "ns_per_pillar");
    outcome.of_ceiling = run.value(row, "of_ceiling");
    outcome.over_bare_copy = run.value(row, "over_bare_copy");
    const SolverPlan plan = plan_of(variant, bench::kSquareMetre);
    outcome.error = measure_force_error(context.device, variant, plan, store.of(plan), kFrames);
    outcomes.push_back(outcome);
  }
  return outcomes;
}

/// The front by time over the bare copy and an error.
std::vector<std::size_t> front_by(const std::vector<Outcome>& outcomes, double ForceError::*error) {
  std::vector<CostAndError> points;
  points.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) {
    points.push_back({outcome.over_bare_copy, outcome.error.*error});
  }
  return pareto_front(points, kResolution);
}

/// Marks the front, and puts the fastest first.
void rank(std::vector<Outcome>& outcomes) {
  std::ranges::sort(outcomes, {}, &Outcome::over_bare_copy);
  for (const std::size_t i : front_by(outcomes, &ForceError::over_bound)) {
    outcomes[i].on_front = true;
  }
}

/// "direct, float, u8, none".
std::string words_of(const SolveVariant& variant) {
  std::string words;
  for (const char letter : name_of(variant)) {
    words += letter == '/' ? std::string(", ") : std::string(1, letter);
  }
  return words;
}

std::string table_of(const std::vector<Outcome>& outcomes) {
  Table table("lrrrrrrr", {"Estimator, arithmetic, sensels, stages", "ns per pillar",
                           "share of its own ceiling", "time over the bare copy", "error, counts",
                           "error over the bound", "all regions, counts", "ambiguous"});
  for (const Outcome& outcome : outcomes) {
    const char* const mark = outcome.on_front ? "**" : "";
    table.add({fmt::format("{0}{1}{0}", mark, words_of(outcome.variant)),
               fmt::format("{:.3g}", outcome.time_ns), fmt::format("{:.3f}", outcome.of_ceiling),
               fmt::format("{0}{1:.3g}{0}", mark, outcome.over_bare_copy),
               fmt::format("{:.3f}", outcome.error.counts),
               fmt::format("{0}{1:.3f}{0}", mark, outcome.error.over_bound),
               fmt::format("{:.2f}", outcome.error.all_counts),
               fmt::format("{:.1f} %", 100 * outcome.error.ambiguous)});
  }
  return table.text();
}

/// "*direct, ...* (1.02 times the bare copy, 1.000 ...); ...".
std::string names_of(const std::vector<Outcome>& outcomes, const std::vector<std::size_t>& front,
                     double ForceError::*error, const char* unit) {
  std::string text;
  for (const std::size_t i : front) {
    const Outcome& outcome = outcomes[i];
    text +=
        fmt::format("{}*{}* ({:.3g} times the bare copy, {:.3f} {})", text.empty() ? "" : "; ",
                    words_of(outcome.variant), outcome.over_bare_copy, outcome.error.*error, unit);
  }
  return text;
}

std::string front_text(const std::vector<Outcome>& outcomes) {
  constexpr auto kOverBound = &ForceError::over_bound;
  constexpr auto kCounts = &ForceError::counts;
  return fmt::format(
      "The front, of {} ways, in bold below: {}. By the error in counts, to which the converter "
      "adds "
      "its own, it is: {}.\n\n",
      outcomes.size(),
      names_of(outcomes, front_by(outcomes, kOverBound), kOverBound, "times the bound"),
      names_of(outcomes, front_by(outcomes, kCounts), kCounts, "counts"));
}

/// A strip of the chart for each type of sensel; colours for estimator and arithmetic, shapes for
/// stages. Columns of the data: time, error, colour, shape, whether on the front.
constexpr const char* kScript = R"(
set logscale x
set xrange [least_time : most_time]
set yrange [0.97 : most_error]
set xtics (0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500)
set format y '%.2f'
set ytics 0.05
set grid xtics ytics linetype 1 linecolor '#dddddd' linewidth 0.7
set multiplot
set lmargin at screen 0.1
set rmargin at screen 0.985
do for [i = 0:2] {
  set tmargin at screen 0.87 - 0.255 * i
  set bmargin at screen 0.64 - 0.255 * i
  set label 1 word('u8 u16 f32', i + 1) at graph 0.012, 0.86 font ',16'
  if (i == 1) { set ylabel 'RMS error over the Cramér–Rao bound' } else { unset ylabel }
  if (i == 2) { set format x '%g'; set xlabel 'time over that of the bare copy' } \
  else { set format x ''; unset xlabel }
  set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead linecolor '#666666' linewidth 1
  plot $points index i using 1:2:4:3 with points pointtype variable linecolor variable \
         pointsize 0.9, \
       '' using ($5 == 1 ? $1 : NaN):2 index i with points pointtype 6 linewidth 1.5 \
         linecolor '#000000' pointsize 2
}
)";

constexpr const char* kLegend = R"(
unset label 1
unset arrow 1
unset xlabel
unset ylabel
unset tics
unset border
unset grid
unset logscale
set xrange [0 : 1]
set yrange [0 : 1]
set tmargin at screen 0.995
set bmargin at screen 0.89
set key at graph 0.5, graph 1 center top vertical Left reverse maxrows 2 width -2 samplen 0.5 font ',12'
plot NaN with points pointtype 7 linetype 6 title 'direct, float', \
     NaN with points pointtype 7 linetype 3 title 'direct, double', \
     NaN with points pointtype 7 linetype 7 title 'paper, float', \
     NaN with points pointtype 7 linetype 2 title 'paper, double', \
     NaN with points pointtype 7 linecolor '#444444' title 'bare', \
     NaN with points pointtype 9 linecolor '#444444' title 'angles', \
     NaN with points pointtype 11 linecolor '#444444' title 'uncertainty', \
     NaN with points pointtype 5 linecolor '#444444' title 'calibration', \
     NaN with points pointtype 13 linecolor '#444444' title 'all', \
     NaN with points pointtype 6 linewidth 1.5 linecolor '#000000' pointsize 2 \
        title 'Pareto front'
unset multiplot
)";

/// A linetype of gnuplot.cpp's.
int colour_of(const SolveVariant& variant) {
  const bool in_float = variant.arithmetic == bench::Arithmetic::device_float;
  if (variant.estimator == Estimator::direct) return in_float ? 6 : 3;
  return in_float ? 7 : 2;
}

int shape_of(const SolveVariant& variant) {
  constexpr std::array<std::pair<std::string_view, int>, 5> kShapes = {
      {{"none", 7}, {"angles", 9}, {"uncertainty", 11}, {"calibration", 5}, {"all", 13}}};
  return std::ranges::find(kShapes, variant.stage, &std::pair<std::string_view, int>::first)
      ->second;
}

void draw(const std::filesystem::path& stem, const std::vector<Outcome>& outcomes) {
  std::string data = "$points << END\n";
  for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    for (const Outcome& outcome : outcomes) {
      if (outcome.variant.type != type) continue;
      data += fmt::format("{} {} {} {} {}\n", outcome.over_bare_copy, outcome.error.over_bound,
                          colour_of(outcome.variant), shape_of(outcome.variant),
                          outcome.on_front ? 1 : 0);
    }
    data += "\n\n";
  }
  const auto [fastest, slowest] = std::ranges::minmax(outcomes, {}, &Outcome::over_bare_copy);
  const double most = std::ranges::max(outcomes, {}, [](const Outcome& outcome) {
                        return outcome.error.over_bound;
                      }).error.over_bound;
  data += fmt::format("END\nleast_time = {}\nmost_time = {}\nmost_error = {}\n",
                      fastest.over_bare_copy / 1.4, slowest.over_bare_copy * 1.4, most + 0.03);
  gnuplot::draw(stem, data + kScript + kLegend, {960, 600});
}

}  // namespace

std::string variants_section(const SpeedContext& context) {
  std::vector<Outcome> outcomes = measure(context);
  rank(outcomes);
  draw(context.docs / "pictures/performance/error_and_time", outcomes);
  return fmt::format(kIntroduction, fmt::arg("noise", bench::kSensorNoiseCounts),
                     fmt::arg("threshold", bench::kSensorThresholdCounts),
                     fmt::arg("pillars", outcomes.front().error.pillars)) +
         front_text(outcomes) + table_of(outcomes);
}

}  // namespace pillarfield::report
