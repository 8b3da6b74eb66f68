// Which scenes tuned the estimator, and which judge it.

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "report/field/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

using field_study::Scene;

constexpr const char* kIntroduction = R"(## Tuning and judging

Weights and limits of the estimator were chosen on the tuning scenes, {tuning} of them, and on a thousand that are drawn at random (`pillarfield_field_page --table drawn` lists them; shapes of the tuning scenes, and a blunt body whose height grows by r² and r⁴); all else on this page is of the judging scenes, {judging}, on which nothing was chosen but one: how near to a friction that is told an open pillar is put, 0.8, was set after a judging scene, a sliding cone that was told its friction, had come out worse than the midpoint; what is said of "friction told" has therefore seen a judge. The sets share no contact, radius, place between the pillars, friction,
direction, load ratio or seed, and the judging scenes have shapes that tuning has not: ellipse, merged spheres, wavy bodies of other waves, truncated cone and rounded punch.

Each contact is seen at each friction with noise of 0.25, 0.5 and 1 counts (normal; float32 readings by equation (2), k = 320 counts per newton, threshold four times the noise), a press at one friction. Frictions of tuning: {tuning_frictions}; of judging: {judging_frictions}.
Pressures and shear are closed forms, integrated over each pillar's cell by Gauss and Legendre's rule, finer where an edge crosses. The number after a name is the contact's radius in pillars. With r in radii:

| shape | pressure | source of its partial slip |
|--|--|--|
| sphere, ellipse | √(1 − r²), √(1 − x² − (y/b)²) | Hertz; Cattaneo and Mindlin |
| paraboloid | 1 − r² | flat punches of all radii, Jäger |
| cone | acosh(1/r) | Love; Jäger |
| truncated cone | acosh(1/r) − acosh(c/r), the latter within c | Jäger |
| rounded punch | √(1 − r²) − √(c² − r²), the latter within c | Jäger |
| cylinder | √(1 − x²) for abs(y) < b | Hertz; Carter |
| two spheres | root of the sum of both squares, where discs overlap | both cores shrink alike: made up |
| merged spheres | the larger of both | the same |
| wavy, A and n waves | √(1 − r²) (1 + A cos nx cos ny) | that of the sphere, times the wave: made up |
| punch | 1/√(1 − r²), at most 100 | a core of shear (1 − r²/c²) less: made up |

What is made up obeys friction everywhere, but no theory of elasticity. Partial slip: friction times (the pressure less that of a smaller contact), at three load ratios (drag over what friction can bear). Roll: the part that touches the leading edge sticks, strip by strip (Carter; Haines and Ollerton).
Spin: about the centre; turn: about a pivot off it; partial turn: shear of partial slip in the directions of a turn.

)";

std::string body_of(const Scene& scene) {
  return scene.contact_name.substr(0, scene.contact_name.find(','));
}

std::string frictions_of(const std::vector<SceneResult>& results) {
  std::set<double> frictions;
  for (const SceneResult& result : results) frictions.insert(result.scene.friction);
  return fmt::format("{:g}", fmt::join(frictions, ", "));
}

/// Motions of a body with the number of contacts.
std::string motions_of(const std::vector<SceneResult>& results, const std::string& body) {
  std::map<std::string, std::set<std::string>> contacts;
  for (const SceneResult& result : results) {
    if (body_of(result.scene) != body) continue;
    contacts[name_of(result.scene.motion())].insert(result.scene.contact_name);
  }
  std::vector<std::string> parts;
  parts.reserve(contacts.size());
  for (const auto& [motion, names] : contacts) {
    parts.push_back(names.size() > 1 ? fmt::format("{} {}", names.size(), motion) : motion);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

void add_bodies(const std::vector<SceneResult>& results, const char* set, Table& table) {
  std::vector<std::string> bodies;
  for (const SceneResult& result : results) {
    const std::string body = body_of(result.scene);
    if (std::find(bodies.begin(), bodies.end(), body) != bodies.end()) continue;
    bodies.push_back(body);
    table.add({set, body, fmt::format("{:g}", result.scene.contact.peak_counts),
               motions_of(results, body)});
  }
}

}  // namespace

std::string sets_section(const FieldContext& context) {
  Table bodies("llrl", {"set", "body", "peak, counts", "motions"});
  add_bodies(context.tuning, "tuning", bodies);
  add_bodies(context.judging, "judging", bodies);
  Table both("lrr", {"ratio to the paper's midpoint", "tuning", "judging"});
  for (const Kind& kind : kinds()) {
    both.add({kind.name, ratio_text(pool_method(context.tuning, kind, 0)),
              ratio_text(pool_method(context.judging, kind, 0))});
  }
  return fmt::format(kIntroduction, fmt::arg("tuning", context.tuning.size()),
                     fmt::arg("judging", context.judging.size()),
                     fmt::arg("tuning_frictions", frictions_of(context.tuning)),
                     fmt::arg("judging_frictions", frictions_of(context.judging))) +
         bodies.text() + "\nBoth sets side by side, nothing said:\n\n" + both.text();
}

}  // namespace pillarfield::report
