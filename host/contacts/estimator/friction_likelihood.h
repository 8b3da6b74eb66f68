#pragma once

#include <vector>

#include "contacts/estimator/friction_posterior.h"

namespace pillarfield {

/// Observed ratio of shear to normal force of a pillar.
struct ObservedRatio {
  double ratio;      ///< |shear| / normal
  double deviation;  ///< relative standard deviation
  /// Largest ratio of a determined force in the pillar's direction of shear
  /// (docs/derivations/contact.md, C4); kNoCeiling if unlimited.
  double ceiling;

  static constexpr double kNoCeiling = 1e3;  ///< above all frictions
};

/// Logarithms of the likelihood for FrictionBelief.
struct FrictionEvidence {
  FrictionCurve estimate{};
  /// A sticking pillar's ratio is a lower bound of the friction, no more (C8a).
  FrictionCurve cautious{};
};

/// Likelihood of the friction coefficient given observed ratios, from tables
/// (docs/derivations/contact.md, section 3).
class FrictionLikelihood {
 public:
  explicit FrictionLikelihood(const ContactParameters& parameters);

  static constexpr std::size_t kMostPillars = 96;  ///< of a call

  /// Adds pillars that slip at the friction or stick below it (C3). The sum over pillars is scaled
  /// to that of at most `effective` pillars.
  void add_slip_or_stick(const std::vector<ObservedRatio>& pillars, double effective,
                         FrictionEvidence& evidence) const;

  /// Adds pillars whose ratio is at least the observed one (C5).
  void add_lower_bounds(const std::vector<ObservedRatio>& pillars, double effective,
                        FrictionEvidence& evidence) const;

 private:
  /// Values by difference of grid points: index j + kPoints for the point `nearest` + j.
  using Differences = std::array<float, 2 * FrictionGrid::kPoints>;

  /// Tables for one standard deviation; deviations of ratios are rounded to the nearest.
  struct Width {
    double deviation = 0;
    Differences density{};     ///< normal density, per unit of the logarithm
    Differences cumulative{};  ///< normal cumulative probability
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
