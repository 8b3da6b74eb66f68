// The error of both estimators under noise, against the Cramér–Rao bound.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "report/section.h"
#include "report/table.h"
#include "testbed/gnuplot.h"
#include "tests/core/bound.h"

namespace pillarfield::report {
namespace {

using bound::Force;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kForceCounts = 60;
constexpr double kFar = 3;  // standard deviations from a border
constexpr int kDraws = 40'000;

constexpr const char* kIntroduction = R"(## Error against the Cramér–Rao bound

No unbiased estimate has a smaller RMS error under noise than the Cramér–Rao bound ([derivation](derivations/bound.md)): 1.118 counts
of force per count of noise in region 1, 1.581 in region 2. Forces of {force} counts from all azimuths are read with normal noise of
0.5, 1 and 2 counts, {draws} times each, with a threshold of five times the noise. The table gives the RMS error of the
vector over the bound, for all azimuths whose readings are {far} standard deviations or more from the threshold, and of readings in which
noise did not change which sensels are usable.

)";

constexpr const char* kPicture = R"(
![Error over the bound against theta](pictures/accuracy/bound.png)

*Error over the bound with one count of noise, along a diagonal of the pillar (φ = 45°) and between diagonal and axis. Grey: a reading
is within {far} standard deviations of the threshold, a border of two regions. Dashed: with the draws that are left out elsewhere, in which noise
changes what is usable. The lines end at region 3, which has no bound.*

)";

constexpr const char* kEnd =
    R"(The direct solve is on the bound: at most {direct:.3f} times, where the draws leave a doubt of {doubt:.3f}. In region 1 the paper's equations
have {paper_least:.2f} to {paper_most:.2f} times the bound, for they take the magnitude from one reading and θ from two (B7). In region 2 three equations
of three unknowns have one solution, and both estimators find it.

In the grey strips two things happen. A sensel that is usable by luck reads too much, and one that is silent tells a little that
the solve does not use: a hump at the border of regions 1 and 2. And next to region 3 a third reading that noise hides makes
the force ambiguous, so that its estimate jumps to the segment point (dashed). At the strip's edge that is one force in 740, yet it
adds {misread:.0f} % to the error at φ = 22.5°; at five standard deviations it is nothing (B6).
)";

/// One newton is one count.
PillarSensor sensor_of(double noise_counts) {
  PillarSensor sensor;
  sensor.threshold_counts = 5 * noise_counts;
  sensor.noise_counts = noise_counts;
  return sensor;
}

/// The errors of both estimators at one force, over the bound.
struct Ratios {
  double direct = 0;
  double direct_with_misread = 0;
  double paper = 0;
};

Ratios measure(Force force, const PillarSensor& sensor, std::uint64_t number) {
  const double least = bound::least_error(force, sensor);
  const bound::RmsError direct =
      bound::rms_error(force, sensor, Estimator::direct, kDraws, 2 * number);
  const bound::RmsError paper =
      bound::rms_error(force, sensor, Estimator::paper, kDraws, 2 * number + 1);
  return {direct.of_rightly_read / least, direct.of_all / least, paper.of_rightly_read / least};
}

bool has_bound(Force force, const PillarSensor& sensor) {
  return bound::usable_sensels(force, sensor) >= 3;
}

/// Ratios of many forces: root mean squares and extremes.
class Summary {
 public:
  void add(const Ratios& ratios) {
    ++count_;
    direct_ += ratios.direct * ratios.direct;
    paper_ += ratios.paper * ratios.paper;
    direct_most_ = std::max(direct_most_, ratios.direct);
    paper_least_ = std::min(paper_least_, ratios.paper);
    paper_most_ = std::max(paper_most_, ratios.paper);
  }

  [[nodiscard]] std::string direct() const { return text_of(direct_); }
  [[nodiscard]] std::string paper() const { return text_of(paper_); }
  [[nodiscard]] double direct_most() const { return direct_most_; }
  [[nodiscard]] double paper_least() const { return paper_least_; }
  [[nodiscard]] double paper_most() const { return paper_most_; }

 private:
  [[nodiscard]] std::string text_of(double sum) const {
    return count_ == 0 ? "–" : fmt::format("{:.2f}", std::sqrt(sum / count_));
  }

  int count_ = 0;
  double direct_ = 0;
  double paper_ = 0;
  double direct_most_ = 0;
  double paper_least_ = std::numeric_limits<double>::infinity();
  double paper_most_ = 0;
};

/// Of all forces that have the same number of usable sensels.
struct ByRegion {
  Summary one;
  Summary two;
};

/// One inclination, azimuths all round a quarter.
std::vector<Force> forces_at(double theta_deg) {
  std::vector<Force> forces;
  for (int i = 0; i < 12; ++i) {
    const double phi_deg = 7.5 * (i + 0.5);
    forces.push_back(bound::force_from(kForceCounts, theta_deg * kDegree, phi_deg * kDegree));
  }
  return forces;
}

bool is_measured(Force force, const PillarSensor& sensor) {
  return has_bound(force, sensor) && bound::is_far_from_borders(force, sensor, kFar);
}

/// "1", "2", "1, 2": where the forces lie that a cell of the table is about.
std::string regions_of(const std::vector<Force>& forces, const PillarSensor& sensor) {
  std::set<int> regions;
  for (const Force& force : forces) {
    if (is_measured(force, sensor)) regions.insert(5 - bound::usable_sensels(force, sensor));
  }
  return fmt::format("{}", fmt::join(regions, ", "));
}

/// The table, and a summary of all that is in it.
std::string table_of_ratios(ByRegion& all) {
  Table table("lrrrrrrr", {"θ", "regions", "noise 0.5: direct", "paper", "1: direct", "paper",
                           "2: direct", "paper"});
  std::uint64_t number = 0;
  for (int theta_deg = 0; theta_deg <= 80; theta_deg += 10) {
    const std::vector<Force> forces = forces_at(theta_deg);
    std::vector<std::string> cells = {fmt::format("{}°", theta_deg),
                                      regions_of(forces, sensor_of(0.5))};
    for (const double noise_counts : {0.5, 1.0, 2.0}) {
      const PillarSensor sensor = sensor_of(noise_counts);
      Summary cell;
      for (const Force& force : forces) {
        if (!is_measured(force, sensor)) continue;
        const Ratios ratios = measure(force, sensor, ++number);
        cell.add(ratios);
        (bound::usable_sensels(force, sensor) == 4 ? all.one : all.two).add(ratios);
      }
      cells.push_back(cell.direct());
      cells.push_back(cell.paper());
    }
    table.add(cells);
  }
  return table.text();
}

constexpr const char* kScript = R"(
set multiplot layout 1,2 margins 0.09, 0.97, 0.17, 0.9 spacing 0.06
set xrange [0 : 90]
set yrange [0.9 : 1.7]
set xtics 15 format '%g°'
set ytics 0.1 format '%.1f'
set xlabel 'inclination θ'
set key at 43, 1.68 left top Left reverse samplen 1.5
do for [i = 0:1] {
  set title word('"φ = 45°" "φ = 22.5°"', i + 1) offset 0,-0.5
  if (i == 0) { set ylabel 'RMS error over the bound' } else { unset key; unset ylabel; set ytics format '' }
  set arrow 1 from 0,1 to 90,1 nohead linecolor '#888888' linewidth 1
  plot $ratios index i using 1:(2 * $5):(1) with boxes fillcolor '#e6e6e6', \
       '' index i using 1:4 with lines linetype 7 title 'paper', \
       '' index i using 1:3 with lines linetype 6 dashtype 2 linewidth 1.5 \
          title 'direct, all', \
       '' index i using 1:2 with lines linetype 6 title 'direct'
}
unset multiplot
)";

/// theta, the ratios, and whether a border is near, along two azimuths.
std::string data_of_plot() {
  const PillarSensor sensor = sensor_of(1);
  std::uint64_t number = 1'000'000;
  std::string data;
  for (const double phi_deg : {45.0, 22.5}) {
    for (int theta_deg = 0; theta_deg < 90; ++theta_deg) {
      const Force force = bound::force_from(kForceCounts, theta_deg * kDegree, phi_deg * kDegree);
      if (!has_bound(force, sensor)) continue;
      const auto [direct, with_misread, paper] = measure(force, sensor, ++number);
      data += fmt::format("{} {:.4f} {:.4f} {:.4f} {}\n", theta_deg, direct, with_misread, paper,
                          bound::is_far_from_borders(force, sensor, kFar) ? 0 : 1);
    }
    data += "\n\n";
  }
  return data;
}

/// By how much misreadings raise the error over the bound, where the third reading of region 2 is
/// just so far from the threshold as the table demands.
double cost_of_misreading() {
  constexpr int kManyDraws = 1'000'000;
  const PillarSensor sensor = sensor_of(1);
  double far = 50;
  double near = 64;
  for (int step = 0; step < 40; ++step) {
    const double middle = (far + near) / 2;
    const Force force = bound::force_from(kForceCounts, middle * kDegree, 22.5 * kDegree);
    (is_measured(force, sensor) ? far : near) = middle;
  }
  const Force force = bound::force_from(kForceCounts, far * kDegree, 22.5 * kDegree);
  const auto error = bound::rms_error(force, sensor, Estimator::direct, kManyDraws, 0);
  return error.of_all / bound::least_error(force, sensor) - 1;
}

}  // namespace

std::string bound_section(const Context& context) {
  gnuplot::draw(context.docs / "pictures/accuracy/bound",
                "$ratios << END\n" + data_of_plot() + "END\n" + kScript, {960, 400});
  ByRegion all;
  const std::string table = table_of_ratios(all);
  return fmt::format(kIntroduction, fmt::arg("force", kForceCounts), fmt::arg("draws", kDraws),
                     fmt::arg("far", kFar)) +
         table + fmt::format(kPicture, fmt::arg("far", kFar)) +
         fmt::format(kEnd,
                     fmt::arg("direct", std::max(all.one.direct_most(), all.two.direct_most())),
                     fmt::arg("doubt", 0.7 / std::sqrt(kDraws)),
                     fmt::arg("paper_least", all.one.paper_least()),
                     fmt::arg("paper_most", all.one.paper_most()),
                     fmt::arg("misread", 100 * cost_of_misreading()));
}

}  // namespace pillarfield::report
