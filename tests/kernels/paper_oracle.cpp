#include <algorithm>
#include <array>
#include <limits>

#include "tests/kernels/oracle.h"

namespace pillarfield::oracle {
namespace {

const Exact kNotANumber = std::numeric_limits<double>::quiet_NaN();
const Force kZeroByZero = {kNotANumber, kNotANumber, kNotANumber};

std::size_t count_of(const SomeReadings& usable) {
  return static_cast<std::size_t>(
      std::ranges::count_if(usable, [](const auto& reading) { return reading.has_value(); }));
}

std::size_t first_idle(const SomeReadings& usable) {
  std::size_t sensel = 0;
  while (sensel < 4 && usable[sensel]) ++sensel;
  return sensel;
}

/// Equation (7), with the signs that determine the quadrant.
Exact azimuth_from_four(const SomeReadings& v) {
  return exact::atan2(*v[2] * *v[3] - *v[0] * *v[1], *v[1] * *v[2] - *v[0] * *v[3]);
}

/// Equation (8), its denominator mended, for the sensels i, j, k that follow an inactive one.
Exact azimuth_from_three(const SomeReadings& v) {
  const std::size_t inactive = first_idle(v);
  const std::size_t i = (inactive + 1) % 4;
  const std::size_t j = (inactive + 2) % 4;
  const std::size_t k = (inactive + 3) % 4;
  const Exact ratio_ik = *v[i] / *v[k];
  const Exact ratio_jk = *v[j] / *v[k];
  const auto sum = [&](const auto& of_angle) {
    const Exact at_i = of_angle(sensel_angle(i));
    const Exact at_j = of_angle(sensel_angle(j));
    const Exact at_k = of_angle(sensel_angle(k));
    return ratio_ik * (at_k - at_j) + ratio_jk * (at_i - at_k) + (at_j - at_i);
  };
  // Numerator and denominator are positive multiples of the shear; phi points against it.
  return exact::atan2(-sum(exact::cos), sum(exact::sin));
}

Exact azimuth(const SomeReadings& v) {
  return count_of(v) == 4 ? azimuth_from_four(v) : azimuth_from_three(v);
}

/// Equation (5), in [0, pi/2].
Exact inclination(const SomeReadings& v, const PaperChoice& choice, Exact phi) {
  const auto [i, j, unused] = choice;
  const Exact ratio = *v[i] / *v[j];
  const Exact denominator =
      ratio * exact::cos(sensel_angle(j) - phi) - exact::cos(sensel_angle(i) - phi);
  return exact::atan2(exact::abs(ratio - 1), exact::abs(denominator));
}

/// Then every tangent is 0/0.
bool all_equal(const SomeReadings& usable) {
  std::optional<Exact> first;
  for (const auto& reading : usable) {
    if (!first) first = reading;
    if (reading && *reading != *first) return false;
  }
  return true;
}

/// Regions 1 and 2.
Force from_three_or_four(const SomeReadings& v, Exact k, const PaperChoice& choice) {
  if (all_equal(v)) return kZeroByZero;
  const Exact phi = azimuth(v);
  const Exact theta = inclination(v, choice, phi);
  const std::size_t m = choice.magnitude_from;
  const Exact response = exact::cos(theta) - exact::sin(theta) * exact::cos(sensel_angle(m) - phi);
  return force_from(*v[m] / (k * response), theta, phi);
}

/// Region 3: the contour of (5) is the directions of the segment of forces; the one whose theta is
/// half way between its ends is found by bisection.
Force half_way_in_theta(const SomeReadings& usable, Exact k) {
  const auto [low, high] = segment_of(usable, k);
  const Exact shear = exact::sqrt(high.shear_x * high.shear_x + high.shear_y * high.shear_y);
  const Exact theta = (exact::pi() / 2 + exact::atan2(shear, high.normal)) / 2;
  const Exact sine = exact::sin(theta);
  const Exact cosine = exact::cos(theta);
  const auto at = [&, from = low, to = high](Exact share) -> Force {
    return {from.shear_x + share * (to.shear_x - from.shear_x),
            from.shear_y + share * (to.shear_y - from.shear_y), share * to.normal};
  };
  Exact flat = 0;
  Exact steep = 1;
  for (int step = 0; step < 115; ++step) {
    const Exact middle = (flat + steep) / 2;
    const Force force = at(middle);
    const Exact squared = force.shear_x * force.shear_x + force.shear_y * force.shear_y;
    const bool flatter = exact::sqrt(squared) * cosine > force.normal * sine;
    (flatter ? flat : steep) = middle;
  }
  return at(flat);
}

/// Region 4.
Force along_the_skin(const SomeReadings& usable, Exact k) {
  for (std::size_t n = 0; n < 4; ++n) {
    if (usable[n])
      return force_from(*usable[n] / k, exact::pi() / 2, sensel_angle(n) + exact::pi());
  }
  return {0, 0, 0};
}

/// P1: the diagonal along which the shear lies more; both near an axis.
std::vector<PaperChoice> diagonals_along_shear(const SomeReadings& usable) {
  constexpr double kTie = 1e-5;
  const Exact phi = azimuth_from_four(usable);
  const Exact rising = exact::abs(exact::cos(sensel_angle(0) - phi));
  const Exact falling = exact::abs(exact::cos(sensel_angle(1) - phi));
  std::vector<PaperChoice> pairs;
  if (!(rising < falling - kTie)) pairs.push_back({0, 2, 0});
  if (!(falling < rising - kTie)) pairs.push_back({1, 3, 0});
  return pairs;
}

/// P2: the sensel opposite the inactive one, and that of its neighbours which differs more from it.
std::vector<PaperChoice> opposite_and_neighbour(const SomeReadings& usable) {
  const std::size_t inactive = first_idle(usable);
  const std::size_t opposite = (inactive + 2) % 4;
  const auto difference = [&](std::size_t neighbour) {
    return exact::abs(*usable[opposite] - *usable[neighbour]);
  };
  const std::size_t one = (inactive + 1) % 4;
  const std::size_t other = (inactive + 3) % 4;
  std::vector<PaperChoice> pairs;
  if (difference(one) >= difference(other)) pairs.push_back({opposite, one, 0});
  if (difference(other) >= difference(one)) pairs.push_back({opposite, other, 0});
  return pairs;
}

}  // namespace

std::vector<PaperChoice> paper_choices(const SomeReadings& usable) {
  if (count_of(usable) < 3) return {{}};
  Exact largest = 0;
  for (const auto& reading : usable) largest = std::max(largest, reading.value_or(0));
  std::vector<PaperChoice> choices;
  const bool four = count_of(usable) == 4;
  for (PaperChoice choice : four ? diagonals_along_shear(usable) : opposite_and_neighbour(usable)) {
    for (std::size_t n = 0; n < 4; ++n) {
      if (usable[n] != largest) continue;
      choice.magnitude_from = n;
      choices.push_back(choice);
    }
  }
  return choices;
}

Force paper_force(const SomeReadings& usable, Exact k, const PaperChoice& choice) {
  if (count_of(usable) >= 3) return from_three_or_four(usable, k, choice);
  const bool opposite = (usable[0] && usable[2]) || (usable[1] && usable[3]);
  if (opposite) return direct_force(usable, k);
  return count_of(usable) == 2 ? half_way_in_theta(usable, k) : along_the_skin(usable, k);
}

}  // namespace pillarfield::oracle
