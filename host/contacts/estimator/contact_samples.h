#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "contacts/estimator/contact_parameters.h"
#include "contacts/estimator/friction_likelihood.h"
#include "contacts/estimator/pressure_regression.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"
#include "solve/segment.h"

namespace pillarfield {

/// Calls `use` with the index of each pillar of a contact whose status byte `marks` marks in a word
/// of eight, by one bit of the byte.
template <class Marks, class Use>
void for_each_marked(const ForceFieldView& forces, std::span<const ContactRun> runs, Marks marks,
                     Use use) {
  for (const ContactRun& run : runs) {
    const std::uint32_t end = run.row * forces.cols + run.end;
    for (std::uint32_t index = run.row * forces.cols + run.first; index < end;
         index += kWordBytes) {
      const std::size_t pillars = std::min<std::size_t>(kWordBytes, end - index);
      std::uint64_t word = 0;
      if (pillars == kWordBytes) {
        std::memcpy(&word, &forces.status[index], kWordBytes);
      } else {
        std::memcpy(&word, &forces.status[index], pillars);
      }
      std::uint64_t marked = marks(word) & (~std::uint64_t{0} >> (8 * (kWordBytes - pillars)));
      for (; marked != 0; marked &= marked - 1) {
        use(index + static_cast<std::uint32_t>(std::countr_zero(marked)) / 8);
      }
    }
  }
}

/// Calls `use` with the index of each pillar of a contact that has a feasible segment.
template <class Use>
void for_each_ambiguous(const ForceFieldView& forces, std::span<const ContactRun> runs, Use use) {
  for_each_marked(
      forces, runs, [](std::uint64_t word) { return word & (kEachByte * status::kAmbiguous); },
      [&](std::uint32_t index) {
        if (has_feasible_segment(forces.status[index])) use(index);
      });
}

/// Calls `use` with the index of each pillar of a contact whose readings leave its force open: all
/// but those of is_determined().
template <class Use>
void for_each_undetermined(const ForceFieldView& forces, std::span<const ContactRun> runs,
                           Use use) {
  const auto marks = [](std::uint64_t word) {
    // Three of four sensels: both of a pair, and one of the other.
    const std::uint64_t both = word & (word >> 1);
    const std::uint64_t one = word | (word >> 1);
    const std::uint64_t usable = (both & (one >> 2)) | ((both >> 2) & one);
    return (~usable | (word >> std::countr_zero(status::kSaturated))) & kEachByte;
  };
  for_each_marked(forces, runs, marks, use);
}

/// Prefetches what lies too far apart for hardware prefetching.
inline void prefetch([[maybe_unused]] const void* from) {
#if defined(__GNUC__)
  __builtin_prefetch(from);
#endif
}

/// Calls `use` with row and column of every `step`-th pillar of a contact.
template <class Use>
void for_each_of(std::span<const ContactRun> runs, std::uint32_t step, Use use) {
  std::uint32_t skip = 0;
  for (const ContactRun& run : runs) {
    std::uint32_t col = run.first + skip;
    for (; col < run.end; col += step) use(run.row, col);
    skip = col - run.end;
  }
}

/// Bounding box of a contact, in pillars.
struct ContactBox {
  std::uint32_t first_row = 0;
  std::uint32_t first_col = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::uint32_t pillars = 0;  ///< of the contact

  [[nodiscard]] static ContactBox about(std::span<const ContactRun> runs);

  /// Coordinates of the regression: from the centre of the box, about 1 at its farther edges.
  [[nodiscard]] double x_of(double col) const {
    return (col - first_col - 0.5 * (cols - 1)) / scale();
  }
  [[nodiscard]] double y_of(double row) const {
    return (row - first_row - 0.5 * (rows - 1)) / scale();
  }
  [[nodiscard]] double scale() const { return 0.5 * (rows > cols ? rows : cols) + 1; }
};

/// Samples of a contact for likelihood and regression (docs/derivations/contact.md, section 3).
/// Memory is reused from contact to contact.
class ContactSamples {
 public:
  /// Largest number of sampled pillars, evenly spread, and of rows or columns sampled at the edge.
  /// Bounds the cost of large contacts.
  static constexpr std::uint32_t kMostPillars = FrictionLikelihood::kMostPillars;
  static constexpr std::uint32_t kMostEdges = 16;

  /// Samples the pillars of a contact. `leans` are those of its ambiguous pillars, or empty without
  /// an arm; `noise_n` is the noise of a reading as a force, N.
  void sample(const ForceFieldView& forces, std::span<const LeanShear> leans,
              std::span<const ContactRun> runs, double noise_n, const SegmentModel& model,
              const ContactParameters& parameters);
  /// Adds samples of zero normal force at the contact's edge to the regression's samples.
  void add_edges();

  [[nodiscard]] const ContactBox& box() const { return box_; }
  /// Ratios of determined pillars, and lower bounds of the ratios of ambiguous pillars.
  [[nodiscard]] const std::vector<ObservedRatio>& ratios() const { return ratios_; }
  [[nodiscard]] const std::vector<ObservedRatio>& bounds() const { return bounds_; }
  [[nodiscard]] std::vector<PressureRegression::Sample>& pressure() { return pressure_; }
  /// Sampled ambiguous pillars, by index in the frame.
  [[nodiscard]] const std::vector<std::uint32_t>& ambiguous() const { return ambiguous_; }
  [[nodiscard]] bool is_subsampled() const { return step_ > 1; }
  /// Sum of shear over that of normal force of the sampled pillars, ambiguous ones with their
  /// largest normal force; zero without.
  [[nodiscard]] double load_ratio() const { return normal_ > 0 ? shear_ / normal_ : 0; }
  /// The magnitude of the sum of shear over the sum of magnitudes: 1 of one direction.
  [[nodiscard]] double alignment() const {
    return shear_ > 0 ? std::sqrt(shear_x_ * shear_x_ + shear_y_ * shear_y_) / shear_ : 1;
  }

 private:
  /// An edge of the contact, `down` or `right` (1, 0 or -1) of a pillar.
  struct Edge {
    std::uint32_t row;
    std::uint32_t col;
    int down;
    int right;
  };

  void sample_pillar(std::uint32_t row, std::uint32_t col, double noise_n,
                     const ContactParameters& parameters);
  void add_load(const single_precision::Force& force);
  void add_edge(const Edge& edge, double weight);
  void add_ends_of_rows();
  void add_ends_of_columns();
  [[nodiscard]] double most_normal(std::uint32_t index) const;

  [[nodiscard]] LeanShear lean_of(std::uint32_t index) const {
    return leans_.empty() ? LeanShear{} : leans_[index];
  }

  ForceFieldView forces_;
  std::span<const LeanShear> leans_;
  std::span<const ContactRun> runs_;
  SegmentModel model_;
  ContactBox box_;
  std::uint32_t step_ = 1;  ///< pillars from one sample to the next
  double peak_n_ = 0;       ///< largest possible normal force of a sampled pillar
  double shear_x_ = 0;      ///< sums of sampled pillars, N
  double shear_y_ = 0;
  double shear_ = 0;
  double normal_ = 0;
  std::vector<ObservedRatio> ratios_;
  std::vector<ObservedRatio> bounds_;
  std::vector<PressureRegression::Sample> pressure_;
  std::vector<std::uint32_t> ambiguous_;
  std::vector<std::uint32_t> top_;     ///< first row of the contact in each sampled column
  std::vector<std::uint32_t> bottom_;  ///< last row, likewise
};

/// The force of a pillar.
[[nodiscard]] inline single_precision::Force force_at(const ForceFieldView& forces,
                                                      std::uint32_t index) {
  return {forces.shear_x[index], forces.shear_y[index], forces.normal[index]};
}

/// The lean of a pillar (docs/derivations/sensor_effects.md, E7); zero without an arm.
[[nodiscard]] LeanShear lean_at(const ForceFieldView& forces, std::uint32_t index,
                                float pitch_over_arm);

/// The segment of an ambiguous pillar.
[[nodiscard]] inline FeasibleSegment segment_at(const ForceFieldView& forces, std::uint32_t index,
                                                const SegmentModel& model, const LeanShear& lean) {
  return segment_of(force_at(forces, index), forces.status[index], model, lean);
}

/// Errors of a pillar's shear and readings beyond noise.
struct PillarError {
  double shear_n = 0;   ///< standard deviation of the shear, N
  double residual = 0;  ///< relative standard deviation of a reading
};

/// Relative standard deviation of a ratio of shear to a normal force, N.
[[nodiscard]] double deviation_of_ratio(double ratio, double normal, double noise_n,
                                        const PillarError& error,
                                        const ContactParameters& parameters);

/// Normal forces above this, N, are ignored: their squares would overflow.
inline constexpr double kMostNormalN = 1e15;

}  // namespace pillarfield
