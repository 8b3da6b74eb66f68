#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "contacts/estimator/contact_parameters.h"
#include "contacts/estimator/normal_estimate.h"
#include "pillarfield/contact_labels.h"
#include "pillarfield/force_field.h"
#include "solve/segment.h"

namespace pillarfield {

/// The last determined normal force of each pillar, scaled from frame to frame with the load of its
/// contact, moved with it, and forgotten without contact (docs/derivations/contact.md, section 4).
class PastPressure {
 public:
  /// Movement of a contact since the frame before, in pillars.
  struct Movement {
    double rows = 0;
    double cols = 0;
  };

  /// Begins a frame of that size with these runs of loaded pillars: what the frame before knew
  /// becomes the past.
  void begin(std::uint32_t rows, std::uint32_t cols, std::span<const ContactRun> runs);

  /// Carries the past of a contact over into this frame. The result does not depend on where the
  /// force of an ambiguous pillar lies on its segment. Thread-safe for different contacts.
  void update(const ForceFieldView& forces, std::span<const ContactRun> runs,
              const Movement& movement, double noise_n, const SegmentModel& model,
              const ContactParameters& parameters);

  /// Normal force of a pillar of an updated contact by its past, limited to the end `high` of its
  /// segment, N, plus noise.
  [[nodiscard]] std::optional<NormalEstimate> at(std::uint32_t index, double high,
                                                 double noise_n) const;

 private:
  /// Knowledge of a frame, [rows, cols] each.
  struct Frame {
    /// Normal forces, N: above zero if determined, below if carried over, zero if unknown.
    std::vector<float> normal;
    /// Variances of those carried over, N²; that of the determined ones is the noise's.
    std::vector<float> variance;
    /// Largest forces that the readings allow, N, of those carried over.
    std::vector<float> most;
    std::vector<ContactRun> runs;  ///< beyond them `normal` is zero
  };
  /// The frame before at the place of a pillar.
  struct Past {
    double normal = 0;
    double variance = 0;
    double most = 0;
  };
  struct Load;

  /// Earlier place of a contact's pillars: between four pillars, the first one so many rows and
  /// columns away.
  struct Origin {
    explicit Origin(const Movement& movement);

    std::int64_t rows;
    std::int64_t cols;
    std::array<double, 4> weights{};  ///< upper left, upper right, lower left, lower right
  };

  void prefetch_before(std::span<const ContactRun> runs, const Origin& origin) const;
  [[nodiscard]] std::optional<Past> before(std::uint32_t row, std::uint32_t col,
                                           const Origin& origin, double noise_square) const;

  std::uint32_t rows_ = 0;
  std::uint32_t cols_ = 0;
  Frame now_;
  Frame before_;
};

}  // namespace pillarfield
