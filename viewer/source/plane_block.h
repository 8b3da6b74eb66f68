#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "pillarfield/force_field.h"

namespace pillarfield::viewer {

/// The planes of a field with angles in one block of whole pages, each plane on a page of its own,
/// as a Processor lays them out. Zero at first.
class PlaneBlock {
 public:
  enum Plane : std::size_t { kShearX, kShearY, kNormal, kMagnitude, kTheta, kPhi, kUncertainty };

  PlaneBlock(std::uint32_t rows, std::uint32_t cols, bool uncertainty);

  /// The planes of Uncertainty follow from kUncertainty on; they are empty where there are none.
  [[nodiscard]] std::span<float> plane(std::size_t which);
  [[nodiscard]] std::span<const float> plane(std::size_t which) const;
  [[nodiscard]] std::span<std::uint8_t> status();
  [[nodiscard]] std::span<const std::uint8_t> status() const;

  [[nodiscard]] ForceFieldView view() const;
  [[nodiscard]] std::span<const std::byte> pages() const { return {pages_.get(), bytes_}; }

 private:
  struct Free {
    void operator()(std::byte* memory) const;
  };

  /// Where plane `which` begins; the status lies behind all others.
  [[nodiscard]] float* place(std::size_t which) const;
  [[nodiscard]] std::uint8_t* status_place() const;
  [[nodiscard]] std::size_t pillars() const { return std::size_t{rows_} * cols_; }

  std::uint32_t rows_;
  std::uint32_t cols_;
  std::size_t planes_;       ///< of floats
  std::size_t plane_bytes_;  ///< from one to the next
  std::size_t bytes_;
  std::unique_ptr<std::byte[], Free> pages_;
};

}  // namespace pillarfield::viewer
