#pragma once

namespace pillarfield {

/// The constants of ContactEstimator, chosen on the training set of
/// docs/decisions/contact_estimator.md. Within the ranges given, its error stays within 10 % of the
/// minimum.
struct ContactParameters {
  /// Prior probability that a determined pillar slips; [0.3, 0.5].
  double slip_probability = 0.4;
  /// Exponent e of the density µ^−e of a sticking pillar's ratio of shear to normal force: 1 for
  /// ratios uniform up to the friction µ, 0 for ratios independent of it; [0.25, 1].
  double stick_exponent = 0.5;
  /// Relative standard deviation, noise apart, of a slipping pillar's ratio about the friction,
  /// since friction varies over a body and traction within a pillar; [0.02, 0.05].
  double ratio_deviation = 0.03;
  /// Standard deviation of a ratio, in units of reading noise over normal force (direct_solve.md).
  double noise_of_ratio = 1.6;
  /// Least normal force of a pillar that enters the likelihood, in units of reading noise; [5, 12].
  double least_normal = 8;
  /// Least ratio that enters the likelihood; most pillars under pure pressing have smaller ones;
  /// [0.1, 0.3].
  double least_ratio = 0.2;
  /// Probability that a pillar is an outlier; [1e-4, 1e-2].
  double outliers = 1e-3;
  /// Relative standard deviation of the ratio at which a second sensel becomes inactive (C4).
  double ceiling_deviation = 0.05;
  /// Largest effective number of independent pillars per contact; [20, 80].
  double effective_pillars = 40;
  /// Largest effective number of pillars whose normal force is predicted by regression; [2, 8].
  double effective_predictions = 4;
  /// Probability that an ambiguous pillar sticks, its normal force uniform between the force at
  /// slip and the segment's end; [0.1, 0.3].
  double ambiguous_sticks = 0.2;
  /// Factor on the spread of the prior for the intervals of ambiguous pillars.
  double cautious_spread = 2;
  /// Fraction of the posterior that the prior replaces from frame to frame; [0.02, 0.1].
  double forgetting = 0.05;
  /// Factor on the regression's standard deviation, since it extrapolates; [2, 3].
  double regression_factor = 2.5;
  /// Least relative standard deviation of a predicted normal force.
  double prediction_deviation = 0.03;
  /// Standard deviation of the true normal force about that of direct on a pillar that leans, as a
  /// fraction of the segment's upper end; [0.08, 0.15].
  double point_deviation = 0.15;
  /// Largest standard deviation of the normal force of a resolved pillar (status bit 7), as a
  /// fraction of the segment's upper end.
  double resolved_deviation = 0.1;
  /// Largest spread of the posterior of a friction that is reported; its deviation is stated.
  double reported_spread = 0.2;
  /// The stated deviation over the spread: pillars are not as independent as C3 takes them.
  double stated_over_spread = 2;
  /// Largest spread of a friction that a frame shows clearly; [0.05, 0.08].
  double clear_spread = 0.06;
  /// Relative distance up to which two frictions count as equal.
  double same_friction = 0.05;
  /// Relative distance from the friction last shown at which the posterior contradicts it: if it is
  /// larger or the contact slides, and if it is smaller while pillars may stick.
  double other_friction = 0.1;
  double unloaded_friction = 0.3;
  /// Fraction of the largest load ratio so far from which a frame counts as newly loaded, and the
  /// least ratio.
  double new_load = 0.99;
  double least_load = 0.02;
  /// Change of the load ratio's logarithm in which the weight of a frame falls by e; [0.15, 0.5].
  double load_memory = 0.3;
  /// Standard deviation of the logarithm of a frame's friction beyond scatter; [0.04, 0.05].
  double friction_noise = 0.05;
  /// Growth of a friction with the load, as an exponent, up to which the friction counts as
  /// constant: of the estimate, and of its upper end, one-sided 95 %. Near 1 if the contact sticks.
  double most_growth = 0.3;
  double most_growth_end = 0.5;
  /// Least load ratio of a contact that slides, over its friction, and alignment of its shear below
  /// which it turns.
  double sliding_load = 0.85;
  double apart = 0.5;
  /// The lower bound of a contact's friction over that of its roughest part, the 5 % quantile of
  /// the cautious posterior.
  double bound_factor = 0.87;
  /// Relative standard deviation of the friction over a contact, as known before its ratios are
  /// seen: usual, as of so many pillars, and where its estimate starts.
  double usual_scatter = 0.05;
  double usual_scatter_pillars = 4;
  double most_scatter = 0.15;
  /// True if pillars remember their normal forces (contact.md, section 4): costly beside a solve
  /// that does not resolve them.
  bool past_pressure = true;
};

}  // namespace pillarfield
