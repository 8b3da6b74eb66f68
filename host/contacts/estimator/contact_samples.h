#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contacts/estimator/contact_parameters.h"
#include "contacts/estimator/friction_evidence.h"
#include "contacts/estimator/pressure_regression.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "solve/segment.h"

namespace pillarfield {

/// The box about a contact, in pillars.
struct ContactBox {
  std::uint32_t first_row = 0;
  std::uint32_t first_col = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::uint32_t pillars = 0;  ///< of the contact

  [[nodiscard]] static ContactBox about(std::span<const ContactRun> runs);

  /// Places in the regression: from the box's middle, about 1 at its farther edges.
  [[nodiscard]] double x_of(double col) const {
    return (col - first_col - 0.5 * (cols - 1)) / scale();
  }
  [[nodiscard]] double y_of(double row) const {
    return (row - first_row - 0.5 * (rows - 1)) / scale();
  }
  [[nodiscard]] double scale() const { return 0.5 * (rows > cols ? rows : cols) + 1; }
};

/// What sampled pillars of a contact show (docs/derivations/contact.md, section 3). Memory is kept
/// from contact to contact.
class ContactSamples {
 public:
  /// Of a contact so many pillars are asked at most, evenly spread, and so many rows and columns
  /// for its edge: what they tell is the same, and large contacts take no longer.
  static constexpr std::uint32_t kMostPillars = 96;
  static constexpr std::uint32_t kMostEdges = 16;

  /// `noise_n`: of a reading, N.
  void take(const ForceFieldView& forces, std::span<const ContactRun> runs, double noise_n,
            const SegmentEnd& end, const ContactParameters& parameters);
  /// Adds the contact's edge, at which the normal force vanishes, to the regression's samples.
  void add_edges();

  [[nodiscard]] const ContactBox& box() const { return box_; }
  /// Ratios of determined pillars, and lower bounds of those of ambiguous ones.
  [[nodiscard]] const std::vector<ShownRatio>& ratios() const { return ratios_; }
  [[nodiscard]] const std::vector<ShownRatio>& bounds() const { return bounds_; }
  [[nodiscard]] const std::vector<PressureRegression::Sample>& pressure() const {
    return pressure_;
  }
  /// Ambiguous pillars, by index in the frame.
  [[nodiscard]] const std::vector<std::uint32_t>& ambiguous() const { return ambiguous_; }
  [[nodiscard]] bool any_passed_over() const { return step_ > 1; }
  [[nodiscard]] bool has_edges() const { return edges_ > 0; }
  /// What the outermost pillars bear, in the mean, over what the heaviest may; after add_edges().
  [[nodiscard]] double edge_load() const { return edges_ > 0 ? edge_loads_ / edges_ : 0; }

 private:
  /// A side at which a contact ends: next to which pillar, and where from there (1, 0 or -1).
  struct Edge {
    std::uint32_t row;
    std::uint32_t col;
    int down;
    int right;
  };

  template <class Ask>
  void for_each_asked(Ask prefetch) const;
  void ask(std::uint32_t row, std::uint32_t col, double noise_n,
           const ContactParameters& parameters);
  void add_edge(const Edge& edge, double weight);
  void add_ends_of_rows();
  void add_ends_of_columns();
  [[nodiscard]] double most_normal(std::uint32_t index) const;

  ForceFieldView forces_;
  std::span<const ContactRun> runs_;
  SegmentEnd end_;
  ContactBox box_;
  std::uint32_t step_ = 1;  ///< from one pillar that is asked to the next
  double peak_n_ = 0;       ///< the largest normal force that an asked pillar may have
  double edge_loads_ = 0;
  double edges_ = 0;
  std::vector<ShownRatio> ratios_;
  std::vector<ShownRatio> bounds_;
  std::vector<PressureRegression::Sample> pressure_;
  std::vector<std::uint32_t> ambiguous_;
  std::vector<std::uint32_t> top_;     ///< first row of the contact in each sampled column
  std::vector<std::uint32_t> bottom_;  ///< and its last
};

/// The force of a pillar.
[[nodiscard]] inline single_precision::Force force_at(const ForceFieldView& forces,
                                                      std::uint32_t index) {
  return {forces.shear_x[index], forces.shear_y[index], forces.normal[index]};
}

/// The segment of an ambiguous pillar.
[[nodiscard]] inline FeasibleSegment segment_at(const ForceFieldView& forces, std::uint32_t index,
                                                const SegmentEnd& end) {
  return segment_of(force_at(forces, index), shear_y_is_free(forces.status[index]), end);
}

/// Relative standard deviation of a ratio of shear to a normal force, N.
[[nodiscard]] double deviation_of_ratio(double normal, double noise_n,
                                        const ContactParameters& parameters);

/// Larger normal forces, N, are none; their squares would not be numbers.
inline constexpr double kMostNormalN = 1e15;

}  // namespace pillarfield
