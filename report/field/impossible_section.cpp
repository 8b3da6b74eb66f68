// Uniform sliding: what no estimator can resolve, and two bodies that show it.

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"
#include "tests/core/field_study_twins.h"

namespace pillarfield::report {
namespace {

using field_study::ClosedForm;
using field_study::Twins;
using field_study::TwinScene;
using Forces = std::vector<double_precision::Force>;

constexpr const char* kIntroduction = R"(## What cannot be known

**Claim.** Where a body slides all over in one direction, so that every pillar lies in region 3, no estimator can tell from readings, of any number of pillars and frames, how much of the force is normal.

*Proof.* Let it drag to the right, so that sensels 1 and 4 read and 2 and 3 are inactive, with a normal force N and a shear (a N, b N) in each pillar and frame. For s in (0, (1 + (a − |b|)/√2)/2] let a second body press with N' = s N and drag with
(a N + √2 (1 − s) N, b N) = (a' N', b' N'), where a' and b' are constants. By the model (2) sensels 1 and 4 of both read k (N + (a ± b) N/√2), and sensels 2 and 3 read nothing: for the first body because it is in region 3, for the second by the choice of s.
So all readings are the same, and the second body is as good as the first: its pressure has the same shape and edge, and it slides all over in one direction, at the friction √(a'² + b'²). Whatever an estimator answers to one it answers to both, so its errors satisfy
‖e₁‖ + ‖e₂‖ ≥ ‖F₁ − F₂‖. ∎

What decides must come from elsewhere: a prior on friction, a bound or the friction itself, or frames in which pillars were determined. Below, a Hertzian contact {diameter:.0f} pillars across, peak {peak:g} counts, slides at friction {friction:g} towards {direction:g}°, and twins of it press s times as much;
the readings of all are the same, with noise of 0.5 counts. RMS errors over the ambiguous pillars, counts.

)";

constexpr const char* kEnd = R"(
Of {} readings of each twin {} differ from the first body's in single precision.
)";

ClosedForm first_of(const TwinScene& twin_scene) {
  ClosedForm scene;
  scene.contact = field_study::contact_of(twin_scene);
  scene.contact_name = "twin";
  scene.friction = twin_scene.friction;
  scene.seed = 700'001;
  scene.loads = std::make_shared<field_study::PillarLoads>(field_study::loads_of(scene.contact));
  return scene;
}

template <class DistanceOf>
double rms(const std::vector<std::size_t>& pillars, DistanceOf distance_of) {
  double squares = 0;
  for (const std::size_t i : pillars) squares += std::pow(distance_of(i), 2);
  return std::sqrt(squares / static_cast<double>(pillars.size()));
}

std::string error_text(const ForceField& solved, const Forces& truth,
                       const std::vector<std::size_t>& pillars) {
  return fmt::format("{:.1f}", rms(pillars, [&](std::size_t i) {
                       return field_study::distance_counts(
                           {solved.shear_x[i], solved.shear_y[i], solved.normal[i]}, truth[i]);
                     }));
}

/// Readings of twins that differ in single precision.
std::size_t different_readings(const Twins& twins) {
  std::size_t different = 0;
  for (std::size_t i = 0; i < twins.first.size(); ++i) {
    const auto a = field_study::readings_counts(twins.first[i]);
    const auto b = field_study::readings_counts(twins.second[i]);
    for (std::size_t n = 0; n < a.size(); ++n) {
      if (static_cast<float>(a[n]) != static_cast<float>(b[n])) ++different;
    }
  }
  return different;
}

}  // namespace

std::string impossible_section(const FieldContext& /*context*/) {
  TwinScene twin_scene;
  const field_study::Recording recording = field_study::record(first_of(twin_scene));
  const field_study::Evaluation evaluation(recording);
  const auto& open = evaluation.open(0);
  const auto solved_by = [&](std::size_t method) {
    SolverPlan plan = recording.plan;
    methods()[method].set(plan, recording.friction);
    return field_study::solve(recording, plan).front();
  };
  const ForceField contact = solved_by(kContact);
  const ForceField paper = solved_by(kPaper);
  std::size_t different = 0;
  Table table("rrrrrrrrr", {"s", "friction", "direction", "distance", "half of it",
                            "`contact`: first", "twin", "`paper`: first", "twin"});
  for (const double share : {0.5, 0.7, 0.9}) {
    twin_scene.normal_share = share;
    const Twins twins = field_study::sliding_twins(twin_scene);
    different += different_readings(twins);
    const double distance = rms(open, [&](std::size_t i) {
      return field_study::distance_counts(twins.first[i], twins.second[i]);
    });
    table.add({fmt::format("{:g}", share), fmt::format("{:.2f}", twins.second_friction),
               fmt::format("{:.1f}°", twins.second_direction_deg), fmt::format("{:.1f}", distance),
               fmt::format("{:.1f}", distance / 2), error_text(contact, twins.first, open),
               error_text(contact, twins.second, open), error_text(paper, twins.first, open),
               error_text(paper, twins.second, open)});
  }
  return fmt::format(fmt::runtime(kIntroduction), fmt::arg("diameter", 2 * twin_scene.radius),
                     fmt::arg("peak", twin_scene.peak_counts),
                     fmt::arg("friction", twin_scene.friction),
                     fmt::arg("direction", twin_scene.direction_deg)) +
         table.text() +
         fmt::format(fmt::runtime(kEnd), 4 * recording.truth.front().pillars(), different);
}

}  // namespace pillarfield::report
