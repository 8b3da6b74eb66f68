// Pictures of what remains wrong.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/quantile.h"
#include "pillarfield/status.h"
#include "report/field/section.h"
#include "testbed/gnuplot.h"

namespace pillarfield::report {
namespace {

using field_study::Observed;
using field_study::Scene;

constexpr const char* kIntroduction = R"(## What remains wrong

The error of the force vector of each pillar of region 3, in counts, in judging scenes: left the paper's midpoint, right the field estimator with nothing said, both in one scale.
Grey pillars are determined by their readings.
)";

/// A scene to look at; the first whose name begins so.
struct Telling {
  const char* file;
  const char* contact;
  double friction;
};

constexpr std::array kTelling = {
    Telling{"sphere_spin", "sphere 30, spin", 2},
    Telling{"two_spheres_partial_slip", "two spheres 19, partial slip 0.9", 1.6},
    Telling{"wavy_spin", "wavy 32 x 6, spin", 2.5},
    Telling{"cone_partial_slip", "cone 33, partial slip 0.5", 1.6},
    Telling{"punch_spin", "punch 31, spin", 2},
    Telling{"sphere_slide", "sphere 30, slide to 3°", 1.6},
};

constexpr const char* kScript = R"(
set multiplot layout 1,2 margins 0.02, 0.86, 0.03, 0.88 spacing 0.03
unset border
unset tics
unset colorbox
set size ratio -1
set autoscale fix
set palette defined (-0.12 '#ffffff', -0.061 '#ffffff', -0.06 '#cccccc', -0.001 '#cccccc', 0 '#fff7ec', 0.15 '#fdd49e', 0.4 '#fc8d59', 0.7 '#d7301f', 1 '#5a0000')
set cbrange [-0.12 * most : most]
set title 'paper''s midpoint' offset 0,-0.9
plot $errors index 0 matrix with image
set title 'field' offset 0,-0.9
set colorbox user origin 0.87,0.06 size 0.02,0.8
set cbtics out
set label 1 'error, counts' at screen 0.99, 0.93 right
plot $errors index 1 matrix with image
unset multiplot
)";

constexpr double kDetermined = -1;  // in the place of errors
constexpr double kNotLoaded = -2;

/// |error| of a pillar of region 3, counts.
std::vector<double> errors_of(const Observed& observed, const ForceField& solved) {
  const ForceField& truth = observed.truth();
  std::vector<double> errors(truth.pillars(), kNotLoaded);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if ((observed.direct().status[i] & status::kUsable) != 0) errors[i] = kDetermined;
  }
  for (const std::size_t i : observed.open()) {
    errors[i] =
        observed.plan().skin.counts_per_newton * std::hypot(solved.shear_x[i] - truth.shear_x[i],
                                                            solved.shear_y[i] - truth.shear_y[i],
                                                            solved.normal[i] - truth.normal[i]);
  }
  return errors;
}

/// Rows from the bottom, as gnuplot draws them. Below zero the scale of errors up to `most` has a
/// band for determined pillars and one for the idle skin.
std::string matrix_of(const std::vector<double>& errors, std::size_t cols, double most) {
  std::string text;
  for (std::size_t row = errors.size() / cols; row-- > 0;) {
    for (std::size_t col = 0; col < cols; ++col) {
      const double value = errors[row * cols + col];
      const double band = value == kDetermined ? -0.03 * most : -0.1 * most;
      text += fmt::format("{:.2f} ", value < 0 ? band : value);
    }
    text += "\n";
  }
  return text + "\n\n";
}

/// The PNG alone: a field as SVG is large.
void draw_png(const std::filesystem::path& stem, const std::string& script) {
  gnuplot::draw(stem, script, {560, 270});
  std::filesystem::remove(stem.string() + ".svg");
}

std::string picture_of(const FieldContext& context, const SceneResult& result, const char* file) {
  const Observed observed(result.scene);
  const auto solved = field_study::solve(result.scene, observed, field_study::methods().front());
  const std::vector<double> theta = errors_of(observed, observed.theta_midpoint());
  std::vector<double> finite;
  std::copy_if(theta.begin(), theta.end(), std::back_inserter(finite),
               [](double value) { return value >= 0; });
  const std::size_t cols = observed.truth().cols;
  const double most = quantile(finite, 0.99);
  draw_png(context.docs / "pictures/field" / file,
           "$errors << END\n" + matrix_of(theta, cols, most) +
               matrix_of(errors_of(observed, *solved), cols, most) +
               fmt::format("END\nmost = {:.2f}\n", most) + kScript);
  return fmt::format(
      "\n![Residual error](pictures/field/{}.png)\n\n*{}: RMS {:.1f} and {:.2f} counts.*\n", file,
      result.scene.name(), result.theta.rms_counts(), result.field().rms_counts());
}

}  // namespace

std::string residual_section(const FieldContext& context) {
  std::string text = kIntroduction;
  for (const Telling& telling : kTelling) {
    const auto found =
        std::find_if(context.judging.begin(), context.judging.end(), [&](const auto& result) {
          const Scene& scene = result.scene;
          return scene.contact_name.starts_with(telling.contact) &&
                 scene.friction == telling.friction && scene.noise_counts == kTypicalNoise;
        });
    if (found != context.judging.end() && found->theta.open > 0) {
      text += picture_of(context, *found, telling.file);
    }
  }
  return text;
}

}  // namespace pillarfield::report
