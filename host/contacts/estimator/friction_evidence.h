#pragma once

#include <vector>

#include "contacts/estimator/friction_belief.h"

namespace pillarfield {

/// A ratio of shear to normal force that a pillar shows.
struct ShownRatio {
  double ratio;      ///< |shear| / normal
  double deviation;  ///< relative standard deviation
  /// Where the pillar's direction of shear has no determined force of a larger ratio
  /// (docs/derivations/contact.md, C4); kNoCeiling if there is no such limit.
  double ceiling;

  static constexpr double kNoCeiling = 1e3;  ///< above all frictions
};

/// Likelihoods of the friction coefficient from what pillars show, tabulated once
/// (docs/derivations/contact.md, section 3).
class FrictionLikelihood {
 public:
  explicit FrictionLikelihood(const ContactParameters& parameters);

  /// Pillars that slip at the friction, or stick below it (C3). The sum over pillars counts as
  /// that of at most `effective` ones.
  void add_slip_or_stick(const std::vector<ShownRatio>& pillars, double effective,
                         FrictionCurve& log_likelihood) const;

  /// Pillars whose ratio is at least the one shown (C5).
  void add_lower_bounds(const std::vector<ShownRatio>& pillars, double effective,
                        FrictionCurve& log_likelihood) const;

 private:
  /// Values at differences of points of the grid: at j + kPoints for the point `nearest + j`.
  using Differences = std::array<float, 2 * FrictionGrid::kPoints>;

  /// A standard deviation that ratios are rounded up to.
  struct Width {
    double deviation = 0;
    Differences density{};     ///< of a normal distribution, per unit of the logarithm
    Differences cumulative{};  ///< probability that the friction's logarithm is larger
  };

  [[nodiscard]] const Width& width_of(double deviation) const;

  static constexpr std::size_t kWidths = 10;
  ContactParameters parameters_;
  std::array<Width, kWidths> widths_;
  Differences below_ceiling_{};
  std::array<float, FrictionGrid::kPoints>
      stick_factor_{};  ///< friction to the power of minus stick_exponent
};

}  // namespace pillarfield
