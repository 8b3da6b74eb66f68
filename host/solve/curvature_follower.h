#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "solve/pattern_equations.h"

namespace pillarfield {

/// Finds the curvature of a bent skin from the readings of its untouched sensels, whose tare is
/// tare + bend_x·x + bend_y·y + bend_xy·xy: least squares over at most 1024 sensels of a frame,
/// without those that are off by more than noise. With too few of them, as under a contact
/// everywhere, the curvature stays (docs/derivations/sensor_effects.md, E8).
class CurvatureFollower {
 public:
  /// The plan must have the planes bend_x, bend_y and bend_xy.
  explicit CurvatureFollower(const SolverPlan& plan);

  /// The change of the curvature to apply before this frame; none while the tare would change by
  /// less than a tenth of the noise.
  std::optional<Curvature> follow(const FrameView& frame);

  /// Follows from a plan with a new tare on, measured at the curvature applied so far.
  void set_plan(const SolverPlan& plan);

  /// The curvature applied so far.
  [[nodiscard]] const Curvature& curvature() const { return applied_; }

 private:
  struct Sample {
    std::size_t row;
    std::size_t col;
    PatternTriple pattern;  ///< counts·mm
    double tare;            ///< of the plane skin
  };

  /// Least squares of `differences` from the tare, with the weights.
  [[nodiscard]] PatternTriple fit(const std::vector<double>& differences,
                                  const std::vector<double>& weights) const;
  /// Residuals at a curvature.
  [[nodiscard]] double left(const std::vector<double>& differences, std::size_t sample,
                            const PatternTriple& curvature) const;
  /// Curvature of least absolute differences, approximately: where to begin.
  [[nodiscard]] PatternTriple rough_fit(const std::vector<double>& differences) const;
  /// A curvature, and the part of the sensels from which it was found.
  struct NearFit {
    PatternTriple curvature;
    double part;
  };
  /// Least squares over the sensels near a curvature.
  [[nodiscard]] NearFit fit_near(const std::vector<double>& differences,
                                 const PatternTriple& curvature) const;

  std::size_t cols_;
  std::vector<Sample> samples_;
  double limit_;            ///< largest difference of an untouched sensel, counts
  PatternTriple spread_{};  ///< RMS of the patterns
  double noise_;
  bool started_ = false;
  Curvature applied_;
};

}  // namespace pillarfield
