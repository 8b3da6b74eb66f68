// Uniform sliding: what no estimator can resolve, and two bodies that show it.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"
#include "tests/core/field_study_twins.h"

namespace pillarfield::report {
namespace {

using field_study::Observed;
using field_study::Scene;
using field_study::Twins;
using field_study::TwinScene;

constexpr const char* kIntroduction = R"(## What cannot be known

**Claim.** Where a body slides all over, in one direction and so that every pillar lies in region 3, no estimator whatever can tell from readings, of any number of
pillars and frames, how much of them is normal force.

*Proof.* Let it drag to the right, so that sensels 1 and 4 read and 2 and 3 are lifted, with a pressure N(x, t) and a shear (a N, b N) in every pillar x and frame t: one direction, and a
friction √(a² + b²). Take any s in (0, s₁], s₁ = (1 + (a − |b|)/√2)/2, and let a second body press with N' = s N and drag with

    (a N + √2 (1 − s) N, b N) = (a' N', b' N'),    a' = (a + √2 (1 − s))/s,    b' = b/s.

By the model (2), V1 and V4 are k (N + (a ± b) N/√2), and the second body's are k (s N + (1 − s) N + (a ± b) N/√2): the same. V2 and V3 are k (N − (a ± b) N/√2) and
k ((2 s − 1) N − (a ± b) N/√2), not above zero: for the first body because it is in region 3, for the second by the choice of s. So all four sensels of all pillars
read the same in all frames. And the second body is as good as the first: its pressure is the first's, scaled, as smooth, with the same edge, zero where that is zero; it slides all over in one direction at one friction, √(a'² + b'²).
Whatever an estimator makes of the readings, it makes the same of both. If its errors are e₁ and e₂, then ‖e₁‖ + ‖e₂‖ ≥ ‖F₁ − F₂‖ in any norm, RMS over pillars and frames among them: one of them is at least half the distance. ∎

So an estimator that beats the middle for one such body loses to it for another, and no shape of pressure helps, since all of the family have it. What helps must come from elsewhere: a bound of the friction ends the family
where a' and b' exceed it; that the body slips at a known friction leaves one of the family; so do frames in which the direction or the ratio changes, or the pillar was not ambiguous.

**Demonstration.** A Hertzian contact {diameter:.0f} pillars across, peak {peak:g} counts, slides at friction {friction:g} towards {direction:g}°; beside it twins that press s times as much.
Readings are rounded to single precision, noise of 0.5 counts with the same seed is added to both. RMS errors over the ambiguous pillars, counts.

)";

constexpr const char* kEnd = R"(
Of {readings} readings of each twin {different} differ from the first body's, rounded to single precision as a recording has them; before that the largest difference is {largest:.0e} counts, the rounding of the model in double precision.
The field estimator, with nothing said, answers both with one field: no answer could have both errors below half the distance.
)";

Scene first_of(const TwinScene& twin_scene) {
  Scene scene;
  scene.contact = field_study::contact_of(twin_scene);
  scene.contact_name = "twin";
  scene.friction = twin_scene.friction;
  scene.seed = 700'001;
  scene.loads = std::make_shared<field_study::PillarLoads>(field_study::loads_of(scene.contact));
  return scene;
}

double error_counts(const ForceField& solved, const std::vector<double_precision::Force>& truth,
                    const std::vector<std::size_t>& pillars) {
  double squares = 0;
  for (const std::size_t i : pillars) {
    const double distance = field_study::distance_counts(
        {solved.shear_x[i], solved.shear_y[i], solved.normal[i]}, truth[i]);
    squares += distance * distance;
  }
  return std::sqrt(squares / static_cast<double>(pillars.size()));
}

double distance_counts(const Twins& twins, const std::vector<std::size_t>& pillars) {
  double squares = 0;
  for (const std::size_t i : pillars) {
    squares += std::pow(field_study::distance_counts(twins.first[i], twins.second[i]), 2);
  }
  return std::sqrt(squares / static_cast<double>(pillars.size()));
}

/// How far the readings of twins are apart.
struct Differences {
  std::size_t readings = 0;
  std::size_t different = 0;  ///< in single precision
  double largest = 0;         ///< in double precision, counts

  void add(const Twins& twins) {
    for (std::size_t i = 0; i < twins.first.size(); ++i) {
      const auto a = field_study::readings_counts(twins.first[i]);
      const auto b = field_study::readings_counts(twins.second[i]);
      for (std::size_t n = 0; n < a.size(); ++n) {
        if (static_cast<float>(a[n]) != static_cast<float>(b[n])) ++different;
        largest = std::max(largest, std::abs(a[n] - b[n]));
      }
    }
    readings = 4 * twins.first.size();
  }
};

}  // namespace

std::string impossible_section(const FieldContext& /*context*/) {
  TwinScene twin_scene;
  const Scene scene = first_of(twin_scene);
  const Observed observed(scene);
  const ForceField field = *field_study::solve(scene, observed, field_study::methods().front());
  const ForceField theta = observed.theta_midpoint();
  Differences differences;
  Table table("rrrrrrrrr", {"s", "friction", "direction", "distance", "half of it", "field: first",
                            "twin", "θ middle: first", "twin"});
  for (const double share : {0.3, 0.5, 0.7, 0.9, 1.03}) {
    twin_scene.normal_share = share;
    const Twins twins = field_study::sliding_twins(twin_scene);
    differences.add(twins);
    const auto& open = observed.open();
    const double distance = distance_counts(twins, open);
    const auto text = [](double counts) { return fmt::format("{:.1f}", counts); };
    table.add({fmt::format("{:g}", share), fmt::format("{:.2f}", twins.second_friction),
               fmt::format("{:.1f}°", twins.second_direction_deg), text(distance),
               text(distance / 2), text(error_counts(field, twins.first, open)),
               text(error_counts(field, twins.second, open)),
               text(error_counts(theta, twins.first, open)),
               text(error_counts(theta, twins.second, open))});
  }
  return fmt::format(kIntroduction, fmt::arg("diameter", 2 * twin_scene.radius),
                     fmt::arg("peak", twin_scene.peak_counts),
                     fmt::arg("friction", twin_scene.friction),
                     fmt::arg("direction", twin_scene.direction_deg)) +
         table.text() +
         fmt::format(kEnd, fmt::arg("readings", differences.readings),
                     fmt::arg("different", differences.different),
                     fmt::arg("largest", differences.largest));
}

}  // namespace pillarfield::report
