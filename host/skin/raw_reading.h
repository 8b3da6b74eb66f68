#pragma once

#include <cstddef>

#include "pillarfield/frame.h"

namespace pillarfield {

/// Calls `use(row, readings)` for each row of sensels; `readings` points to the first one, in the
/// frame's type.
template <class Use>
void for_each_row(const FrameView& frame, Use use) {
  const auto rows_of = [&](const auto* readings) {
    for (std::size_t row = 0; row < frame.rows; ++row) use(row, readings + row * frame.row_stride);
  };
  switch (frame.type) {
    case SenselType::u8:
      return rows_of(static_cast<const std::uint8_t*>(frame.data));
    case SenselType::u16:
      return rows_of(static_cast<const std::uint16_t*>(frame.data));
    case SenselType::f32:
      break;
  }
  rows_of(static_cast<const float*>(frame.data));
}

/// One reading of a frame, counts.
[[nodiscard]] inline float raw_reading(const FrameView& frame, std::size_t row, std::size_t col) {
  const std::size_t index = row * frame.row_stride + col;
  switch (frame.type) {
    case SenselType::u8:
      return static_cast<const std::uint8_t*>(frame.data)[index];
    case SenselType::u16:
      return static_cast<const std::uint16_t*>(frame.data)[index];
    case SenselType::f32:
      break;
  }
  return static_cast<const float*>(frame.data)[index];
}

/// Throws Error at `where` unless the frame has this size and type.
void require_frame(const FrameView& frame, const Skin& skin, SenselType type,
                   const std::string& where);

}  // namespace pillarfield
