#pragma once

namespace pillarfield {

/// The constants of ContactEstimator: what it assumes of contacts and readings. Chosen on the
/// training histories of docs/decisions/contact_estimator.md; ranges are those in which the error
/// on them stays within a tenth of the least.
struct ContactParameters {
  /// Prior probability that a determined pillar slips; [0.3, 0.5].
  double slip_probability = 0.4;
  /// A sticking pillar's ratio of shear to normal force has a density that falls with friction as
  /// its power of minus this: 1 if ratios are uniform up to the friction, 0 if they tell nothing of
  /// it; [0.25, 1].
  double stick_exponent = 0.5;
  /// Relative standard deviation of a slipping pillar's ratio about the friction, beside noise:
  /// friction varies over a body, and a pillar is not a point; [0.02, 0.05].
  double ratio_deviation = 0.03;
  /// Standard deviation of a ratio, in noise of a reading over normal force (direct_solve.md).
  double noise_of_ratio = 1.6;
  /// Least normal force of a pillar that is asked, in noise of a reading; [5, 12].
  double least_normal = 8;
  /// Pillars of smaller ratios tell nothing of friction: most of a body that is only pressed
  /// are; [0.1, 0.3].
  double least_ratio = 0.2;
  /// Probability that a pillar follows none of the above; [1e-4, 1e-2].
  double outliers = 1e-3;
  /// Ratios at which two sensels become inactive are known to this relative deviation.
  double ceiling_deviation = 0.05;
  /// Pillars of one contact are not independent witnesses: however many there are, they count as so
  /// many; [20, 80].
  double effective_pillars = 40;
  /// The same of pillars whose normal force the regression of the pressure predicts; [2, 8].
  double effective_predictions = 4;
  /// Probability that an ambiguous pillar sticks; its normal force is then uniform between that at
  /// slip and the segment's end; [0.1, 0.3].
  double ambiguous_sticks = 0.2;
  /// Share of the prior that a belief takes on from frame to frame; [0.02, 0.1].
  double forgetting = 0.05;
  /// The regression's standard deviation is its residual's times this, for it extrapolates; [2, 3].
  double regression_factor = 2.5;
  /// Least relative standard deviation of a predicted normal force.
  double prediction_deviation = 0.03;
  /// An ambiguous pillar counts as resolved (status bit 7) up to this standard deviation of its
  /// normal force over its segment's length.
  double resolved_deviation = 0.1;
  /// A friction is reported up to this standard deviation of its logarithm; [0.01, 0.03].
  double reported_spread = 0.02;
  /// A friction is the same as before within this relative distance,
  double same_friction = 0.05;
  /// and the mean ratio of a contact's pillars another beyond this.
  double other_load = 0.1;
  /// A contact whose outermost pillars bear more than this share of the largest force, in the mean,
  /// may be a flat face.
  double face_load = 0.73;
};

}  // namespace pillarfield
