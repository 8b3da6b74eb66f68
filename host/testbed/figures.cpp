#include "testbed/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <system_error>

#include "pillarfield/error.h"
#include "testbed/curves.h"
#include "testbed/gnuplot.h"
#include "testbed/magnitude.h"

namespace pillarfield::testbed {
namespace {

/// Returns a data block, `$name` in a script.
std::string data_block(const std::string& name, const std::string& lines) {
  return fmt::format("${} << END\n{}END\n", name, lines);
}

std::string line_of(Angles angles) { return fmt::format("{} {}\n", angles.phi, angles.theta); }

constexpr const char* kRegionsScript = R"(
top = pi / 2
set xrange [0 : 2 * pi]
set yrange [0 : top]
set xlabel 'azimuth φ (rad)'
set ylabel 'inclination θ (rad)'
set xtics ('0' 0, 'π/4' pi/4, 'π/2' pi/2, '3π/4' 3*pi/4, 'π' pi, '5π/4' 5*pi/4, '3π/2' 3*pi/2, \
           '7π/4' 7*pi/4, '2π' 2*pi)
set ytics ('0' 0, 'π/8' pi/8, 'π/4' pi/4, '3π/8' 3*pi/8, 'π/2' top)
set border 15
set tmargin 2.5
do for [n = 1:4] {
  set label sprintf('V_%d = 0', n) at (2*n - 1) * pi/4, 0.67 center \
      textcolor linetype word('6 7 4 8', n)
}
border(theta) = theta < top ? theta : NaN
plot $borders using 1:6:(top) with filledcurves fillcolor '#E2EFF8', \
     '' using 1:7:(top) with filledcurves fillcolor '#FAE6BE', \
     '' using 1:(border($2)) with lines linetype 6, \
     '' using 1:(border($3)) with lines linetype 7, \
     '' using 1:(border($4)) with lines linetype 4, \
     '' using 1:(border($5)) with lines linetype 8, \
     $corners using 1:2:3 with labels offset 0,0.9, \
     '' using 1:2 with points linetype 1 pointtype 7 pointsize 1
)";

/// Columns: phi, the borders of sensels 1 to 4, and the lowest two, which bound regions 2 and 3.
std::string borders() {
  constexpr int kSteps = 720;
  std::string lines;
  for (int step = 0; step <= kSteps; ++step) {
    const double phi = 2 * kPi * step / kSteps;
    std::array<double, 4> theta = {border_theta(1, phi), border_theta(2, phi), border_theta(3, phi),
                                   border_theta(4, phi)};
    lines += fmt::format("{} {}", phi, fmt::join(theta, " "));
    std::sort(theta.begin(), theta.end());
    lines += fmt::format(" {} {}\n", theta[0], theta[1]);
  }
  return data_block("borders", lines);
}

std::string region_labels() {
  std::string labels;
  std::string corners;
  for (const auto& [name, place] : kRegionLabels) {
    labels += fmt::format("set label '{}' at {}, {} center front\n", name, place.phi, place.theta);
  }
  for (const auto& [name, place] : kCornerLabels) {
    corners += fmt::format("{} {} {}\n", place.phi, place.theta, name);
  }
  return labels + data_block("corners", corners);
}

constexpr const char* kContoursScript = R"(
set xrange [pi/4 - 0.06 : 3*pi/4 + 0.06]
set yrange [0.82 : pi/2]
set xlabel 'azimuth φ (rad)'
set ylabel 'inclination θ (rad)'
set xtics ('π/4' pi/4, '3π/8' 3*pi/8, 'π/2' pi/2, '5π/8' 5*pi/8, '3π/4' 3*pi/4)
set ytics 0.9, 0.1, 1.5 format '%.1f'
set ytics add ('π/2' pi/2)
set border 15
set label 'V_2 = 0' at 1.12, 1.04 center textcolor linetype 7
set label 'V_1 = 0' at pi - 1.12, 1.04 center textcolor linetype 6
set label 'contours: R = V_3 / V_4' at pi/4 - 0.03, 0.86
set key at 3*pi/4 + 0.04, 0.93 samplen 1
plot $border using 1:4:(pi/2) with filledcurves fillcolor '#FAE6BE', \
     '' using 1:($1 > 1.57 ? $2 : NaN) with lines linetype 6, \
     '' using 1:($1 < 1.571 ? $3 : NaN) with lines linetype 7, \
     for [i = 0:8] $contours index i using 1:2 with lines linetype 1 linewidth 1.2, \
     $names index 0 using 1:2:3 with labels left offset 0.7,-0.4, \
     '' index 1 using 1:2:3 with labels center offset 0,-0.8, \
     '' index 2 using 1:2:3 with labels right offset -0.7,-0.4, \
     $direct using 1:2 with points linetype 4 pointsize 1.3 title '7/8 of the segment (direct)', \
     $paper using 1:2 with points pointtype 7 pointsize 1.2 linecolor '#ffffff', \
     '' using 1:2 with points linetype 1 pointsize 1.2 title 'midpoint in θ (paper)'
)";

/// Ratios V3 / V4 of Figure 4.
constexpr std::array<std::pair<const char*, double>, 9> kRatios = {{
    {"1/8", 0.125},
    {"1/4", 0.25},
    {"1/2", 0.5},
    {"2/3", 2.0 / 3},
    {"1", 1},
    {"3/2", 1.5},
    {"2", 2},
    {"4", 4},
    {"8", 8},
}};

/// Columns: phi, the borders of sensels 1 and 2, and their maximum, the lower bound of region 3.12.
std::string border_of_region_312() {
  constexpr int kSteps = 200;
  std::string lines;
  for (int step = 0; step <= kSteps; ++step) {
    const double phi = kPi * (0.25 + 0.5 * step / kSteps);
    const double first = border_theta(1, phi);
    const double second = border_theta(2, phi);
    lines += fmt::format("{} {} {} {}\n", phi, first, second, std::max(first, second));
  }
  return data_block("border", lines);
}

/// The contours and the labels of their lower ends, in one index each for R < 1, R = 1 and R > 1.
std::string contours() {
  std::string lines;
  std::string names;
  for (const auto& [name, ratio] : kRatios) {
    const std::vector<Angles> points = contour(ratio, 60);
    for (const Angles& point : points) lines += line_of(point);
    lines += "\n\n";
    if (ratio == 1) names += "\n\n";
    names += fmt::format("{} {} {}\n", points.back().phi, points.back().theta, name);
    if (ratio == 1) names += "\n\n";
  }
  return data_block("contours", lines) + data_block("names", names);
}

std::string points_of_ratio_2() {
  return data_block("paper", line_of(point_on_contour(2, Estimator::paper))) +
         data_block("direct", line_of(point_on_contour(2, Estimator::direct)));
}

constexpr const char* kUncertaintyScript = R"(
set xrange [-2 : 2]
set yrange [0 : 0.35]
set xlabel 'log_{10} R, the ratio of the two readings'
set ylabel 'half-width of the interval (rad)'
set xtics 0.5
set ytics 0.05 format '%.2f'
plot $half_widths using 1:2 with lines linetype 6 linewidth 2.5 \
       title sprintf('θ, at most %.3f rad', theta_most), \
     '' using 1:3 with lines linetype 7 linewidth 2.5 title sprintf('φ, at most %.3f rad', phi_most)
)";

std::string uncertainty() {
  constexpr int kSteps = 400;
  std::string lines;
  for (int step = 0; step <= kSteps; ++step) {
    const double logarithm = -2 + 4.0 * step / kSteps;
    const Angles half = half_widths(std::pow(10, logarithm));
    lines += fmt::format("{} {} {}\n", logarithm, half.theta, half.phi);
  }
  return data_block("half_widths", lines) +
         fmt::format("theta_most = {}\nphi_most = {}\n", half_widths(1).theta, half_widths(2).phi);
}

constexpr const char* kMagnitudeScript = R"(
set multiplot layout 1,3 margins 0.095, 0.795, 0.24, 0.9 spacing 0.025
set xrange [0 : 108]
set yrange [0 : 130]
set xtics 20
set ytics 20
set xlabel 'applied (N)'
set key at screen 0.805, screen 0.9 left top Left reverse samplen 1.5
set ylabel 'calculated (N)'
do for [i = 0:2] {
  set title word('"Region 1" "Region 2" "Region 3"', i + 1) offset 0,-0.5
  if (i > 0) { unset ylabel; unset key; set ytics format '' }
  plot $series index i using 1:2:3 with filledcurves fillcolor '#c8c8c8' title 'uncertain angles', \
       '' index i using 1:1 with lines linetype 1 linewidth 1 title 'truth', \
       '' index i every ::1 using 1:4 with points linetype 7 title 'paper', \
       '' index i every ::1 using 1:5 with points linetype 6 title 'direct', \
       '' index i every ::1 using ($7 > $6 ? $1 : NaN):5:6:7 with yerrorbars linetype 6 \
           title 'interval'
}
unset multiplot
)";

/// Columns for each site: applied force, band, both estimates and the interval.
std::string magnitudes(const Parameters& parameters) {
  std::string lines;
  for (const auto& site : magnitude_figure(parameters)) {
    lines += "0 0 0\n";
    for (const MagnitudePoint& point : site) {
      lines += fmt::format("{} {} {} {} {} {} {}\n", point.applied_n, point.uncertain.low,
                           point.uncertain.high, point.paper_n, point.direct_n, point.possible.low,
                           point.possible.high);
    }
    lines += "\n\n";
  }
  return data_block("series", lines);
}

}  // namespace

void draw_figures(const std::filesystem::path& folder, const Parameters& parameters,
                  Replace replace) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error(folder.string(), error.message(), "choose a folder that can be written");
  const auto draw = [&](const char* name, const std::string& script, gnuplot::Size size = {}) {
    gnuplot::draw(folder / name, script, size, replace);
  };
  draw("figure_3_regions", borders() + region_labels() + kRegionsScript);
  draw("figure_4_contours",
       border_of_region_312() + contours() + points_of_ratio_2() + kContoursScript);
  draw("figure_5_uncertainty", uncertainty() + kUncertaintyScript);
  draw("figure_8_magnitude", magnitudes(parameters) + kMagnitudeScript, {1040, 370});
}

}  // namespace pillarfield::testbed
