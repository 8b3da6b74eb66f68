#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "pillarfield/skin.h"

namespace pillarfield {

/// One frame of readings in memory that somebody else owns.
struct FrameView {
  const void* data = nullptr;  ///< first reading of row 0, aligned to its type
  SenselType type = SenselType::u8;
  std::uint32_t rows = 0;      ///< sensel rows
  std::uint32_t cols = 0;      ///< sensel columns
  std::size_t row_stride = 0;  ///< readings from one row to the next, at least cols
};

/// One frame of readings, dense, zero at first, on a page boundary so that a device which shares
/// the host's memory reads it in place.
class FrameBuffer {
 public:
  FrameBuffer(SenselType type, std::uint32_t rows, std::uint32_t cols);

  [[nodiscard]] FrameView view() const;
  [[nodiscard]] std::span<std::byte> bytes() { return {data_.get(), size_}; }
  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

  /// The readings as T; T must be the type the buffer was made for.
  template <class T>
  [[nodiscard]] std::span<T> readings() {
    return {reinterpret_cast<T*>(data_.get()), size_ / sizeof(T)};
  }
  template <class T>
  [[nodiscard]] std::span<const T> readings() const {
    return {reinterpret_cast<const T*>(data_.get()), size_ / sizeof(T)};
  }

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };
  SenselType type_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  std::size_t size_;
  std::unique_ptr<std::byte[], Free> data_;
};

}  // namespace pillarfield
