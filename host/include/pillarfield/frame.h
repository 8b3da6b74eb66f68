#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "pillarfield/skin.h"

namespace pillarfield {

/// One frame of readings in the caller's memory, row by row from the top left of the skin, counts.
///
///     std::vector<std::uint16_t> readings(rows * cols);
///     FrameView frame = {readings.data(), SenselType::u16, rows, cols, cols};
struct FrameView {
  const void* data = nullptr;  ///< reading of row 0, column 0; aligned to its type
  SenselType type = SenselType::u8;
  std::uint32_t rows = 0;      ///< sensel rows
  std::uint32_t cols = 0;      ///< sensel columns
  std::size_t row_stride = 0;  ///< readings from one row to the next, at least cols
};

class FrameBuffer;

/// Makes readings that fall under load rise: r becomes 255 − r of uint8, 65535 − r of uint16, −r of
/// float32.
void mirror(FrameBuffer& frame);

/// A rectangle of sensels.
struct SenselBlock {
  std::uint32_t first_row = 0;
  std::uint32_t rows = 0;
  std::uint32_t first_col = 0;
  std::uint32_t cols = 0;
};

/// Throws Error, naming `where`, if the frame is not of this size and type, has no data, or its
/// rows overlap.
void check(const FrameView& frame, const Skin& skin, SenselType type, std::string_view where);

/// Copies the readings to `to`, rows without gaps.
void copy_readings(const FrameView& frame, std::byte* to);

/// One frame of readings that owns its memory. Its rows are dense, its readings start at zero, and
/// its memory starts on a page boundary, so that a device that shares the host's memory reads it in
/// place. For a device with memory of its own see Processor::frame_buffer().
class FrameBuffer {
 public:
  /// Allocates `rows` x `cols` readings.
  FrameBuffer(SenselType type, std::uint32_t rows, std::uint32_t cols);
  /// Takes `memory` for as many readings, aligned to their type, and sets them to zero.
  FrameBuffer(SenselType type, std::uint32_t rows, std::uint32_t cols,
              std::shared_ptr<std::byte[]> memory);
  FrameBuffer(FrameBuffer&&) noexcept = default;
  FrameBuffer& operator=(FrameBuffer&&) noexcept = default;

  [[nodiscard]] FrameView view() const;
  [[nodiscard]] std::span<std::byte> bytes() { return {data_.get(), size_}; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  /// The readings, [rows, cols]. T must be the buffer's type: std::uint8_t, std::uint16_t or float.
  template <class T>
  [[nodiscard]] std::span<T> readings() {
    return {reinterpret_cast<T*>(data_.get()), size_ / sizeof(T)};
  }
  template <class T>
  [[nodiscard]] std::span<const T> readings() const {
    return {reinterpret_cast<const T*>(data_.get()), size_ / sizeof(T)};
  }

 private:
  SenselType type_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  std::size_t size_;
  std::shared_ptr<std::byte[]> data_;
};

}  // namespace pillarfield
