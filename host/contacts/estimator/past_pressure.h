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

  /// Begins a frame of that size: what the frame before knew becomes the past.
  void begin(std::uint32_t rows, std::uint32_t cols);

  /// Carries the past of a contact over into this frame. The result does not depend on where the
  /// force of an ambiguous pillar lies on its segment. Thread-safe for different contacts.
  void update(const ForceFieldView& forces, std::span<const ContactRun> runs,
              const Movement& movement, double noise_n, const SegmentModel& model,
              const ContactParameters& parameters);

  /// What the past says of a pillar of an updated contact, limited to the end `high` of its
  /// segment, N, plus noise.
  [[nodiscard]] std::optional<NormalEstimate> at(std::uint32_t index, double high,
                                                 double noise_n) const;

 private:
  /// A pillar at a frame.
  struct Cell {
    float normal = 0;    ///< N
    float variance = 0;  ///< N²
    float most = 0;      ///< largest normal force that its readings allow, N
    std::uint32_t frame = 0;
  };
  struct Load;

  /// Where pillars of a contact were: between four pillars, of which the first is so many rows and
  /// columns away.
  struct Origin {
    explicit Origin(const Movement& movement);

    std::int64_t rows;
    std::int64_t cols;
    std::array<double, 4> weights;  ///< upper left, upper right, lower left, lower right
  };

  [[nodiscard]] std::optional<Cell> before(std::uint32_t row, std::uint32_t col,
                                           const Origin& origin) const;
  void keep(std::uint32_t index, double normal, double variance, double most);

  std::uint32_t rows_ = 0;
  std::uint32_t cols_ = 0;
  std::uint32_t frame_ = 1;
  std::vector<Cell> now_;
  std::vector<Cell> before_;
};

}  // namespace pillarfield
