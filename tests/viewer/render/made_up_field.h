#pragma once

#include <functional>
#include <string>

#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

/// An arbitrary pillar.
struct MadeUpPillar {
  float shear_x = 0, shear_y = 0, normal = 0;  ///< N
  std::uint8_t status = 15;                    ///< all four sensels usable
};

/// A field with angles, uncertainty and readings from a function of row and column, on its own
/// pages.
class MadeUpField {
 public:
  using Pillar = std::function<MadeUpPillar(std::uint32_t row, std::uint32_t col)>;
  MadeUpField(std::uint32_t rows, std::uint32_t cols, const Pillar& pillar);

  /// The same normal forces as those of a skin of bare sensels, without readings.
  [[nodiscard]] MadeUpField without_pillars() const;

  [[nodiscard]] const ShownField& shown() const { return shown_; }
  [[nodiscard]] const SourceInfo& source() const { return source_; }

 private:
  ShownField shown_;
  SourceInfo source_;
};

}  // namespace pillarfield::viewer
