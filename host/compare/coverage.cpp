#include "pillarfield/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pillarfield/error.h"
#include "solve/pillar_maths.h"

namespace pillarfield {
namespace {

using double_precision::Direction;
using double_precision::Force;

constexpr double kBand = 1.96;    // standard deviations that hold 95 % of a normal distribution
constexpr double kEndsSlack = 3;  // standard deviations
/// Noise of the vector in region 3, by that of the shear component that readings determine: 1.30 at
/// any segment point but for 2 %.
constexpr double kNoiseOfSegment = 1.3;
constexpr double kSingle = 1e-6;  // rounding of planes in single precision
constexpr double kTurn = 2 * std::numbers::pi;

/// The uncertainty of one pillar.
class Stated {
 public:
  Stated(const ForceFieldView& field, std::size_t pillar) : field_(field), pillar_(pillar) {}

  double operator[](Uncertainty plane) const { return field_.uncertainty[plane][pillar_]; }

  /// Standard deviation that noise gives the force's vector, N. That of ambiguous pillars is taken
  /// from the components that hold nothing else (docs/derivations/uncertainty.md, U3, U9).
  [[nodiscard]] double noise_deviation() const {
    const double x = (*this)[Uncertainty::shear_x];
    const double y = (*this)[Uncertainty::shear_y];
    const double normal = (*this)[Uncertainty::normal];
    const std::uint8_t bits = field_.status[pillar_];
    const bool ambiguous =
        (bits & status::kAmbiguous) != 0 && (bits & status::kFromNeighbours) == 0;
    if (ambiguous && region_of(bits) == Region::three) return kNoiseOfSegment * std::min(x, y);
    // The normal force of region 4 has no noise, and the shear half of its variance each way.
    if (ambiguous && region_of(bits) == Region::four) {
      return std::sqrt(std::max(0.0, x * x + y * y - normal * normal));
    }
    return std::hypot(x, y, normal);
  }

 private:
  const ForceFieldView& field_;
  std::size_t pillar_;
};

bool is_between(double value, double low, double high, double slack) {
  return value >= low - slack && value <= high + slack;
}

/// The same for an angle that runs counter-clockwise from low to high.
bool is_between_turns(double angle, double low, double high, double slack) {
  const double width = high >= low ? high - low : high - low + kTurn;
  const double beyond_low = std::remainder(angle - low - width / 2, kTurn);
  return std::abs(beyond_low) <= width / 2 + slack;
}

bool lies_between_ends(const Direction& truth, const Stated& stated) {
  const double slack = kEndsSlack * stated.noise_deviation() + kSingle * truth.magnitude;
  const double angle_slack = truth.magnitude > 0 ? slack / truth.magnitude : kTurn;
  const double sine = std::sin(truth.theta);
  const double phi_slack = sine > 0 ? angle_slack / sine : kTurn;
  return is_between(truth.magnitude, stated[Uncertainty::magnitude_low],
                    stated[Uncertainty::magnitude_high], slack) &&
         is_between(truth.theta, stated[Uncertainty::theta_low], stated[Uncertainty::theta_high],
                    angle_slack) &&
         is_between_turns(truth.phi, stated[Uncertainty::phi_low], stated[Uncertainty::phi_high],
                          phi_slack);
}

void check_stated(const ForceFieldView& solved, const ForceFieldView& truth) {
  if (solved.rows != truth.rows || solved.cols != truth.cols ||
      truth.normal.size() != solved.status.size()) {
    throw Error("solved forces", fmt::format("have {} x {} pillars", solved.rows, solved.cols),
                fmt::format("the truth has {} x {}", truth.rows, truth.cols));
  }
  for (const auto& plane : solved.uncertainty) {
    if (plane.size() == solved.status.size()) continue;
    throw Error("solved forces", "have no uncertainty", "solve with uncertainty among the outputs");
  }
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

void Coverage::add(const ForceFieldView& solved, const ForceFieldView& truth) {
  check_stated(solved, truth);
  for (std::size_t i = 0; i < solved.status.size(); ++i) {
    if ((solved.status[i] & (status::kSaturated | status::kInconsistent)) != 0) continue;
    const Stated stated(solved, i);
    Counts& counts = counts_[static_cast<std::size_t>(region_of(solved.status[i]))];
    ++counts.pillars;
    const std::array errors = {double{solved.shear_x[i]} - truth.shear_x[i],
                               double{solved.shear_y[i]} - truth.shear_y[i],
                               double{solved.normal[i]} - truth.normal[i]};
    for (std::size_t component = 0; component < errors.size(); ++component) {
      const double band = kBand * stated[static_cast<Uncertainty>(component)];
      counts.within[component] += std::abs(errors[component]) <= band ? 1U : 0U;
    }
    const Force force = {truth.shear_x[i], truth.shear_y[i], truth.normal[i]};
    counts.between_ends +=
        lies_between_ends(double_precision::direction_of(force), stated) ? 1U : 0U;
  }
}

RegionCoverage Coverage::region(Region region) const {
  const Counts& counts = counts_[static_cast<std::size_t>(region)];
  return {counts.pillars, share(counts.within[0], counts.pillars),
          share(counts.within[1], counts.pillars), share(counts.within[2], counts.pillars),
          share(counts.between_ends, counts.pillars)};
}

}  // namespace pillarfield
