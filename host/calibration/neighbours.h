#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "pillarfield/skin.h"

namespace pillarfield {

/// Neighbours of a sensel: up to eight, those at its edges first.
class Neighbours {
 public:
  Neighbours(const Skin& skin, std::size_t sensel) {
    constexpr std::array<std::array<int, 2>, 8> kOffsets = {
        {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}}};
    const auto row = static_cast<int>(sensel / skin.cols);
    const auto col = static_cast<int>(sensel % skin.cols);
    for (const auto& [down, right] : kOffsets) {
      const int r = row + down;
      const int c = col + right;
      if (r < 0 || c < 0 || r >= static_cast<int>(skin.rows) || c >= static_cast<int>(skin.cols)) {
        continue;
      }
      all_.at(count_++) = static_cast<std::size_t>(r) * skin.cols + static_cast<std::size_t>(c);
      if (down == 0 || right == 0) edges_ = count_;
    }
  }

  [[nodiscard]] std::span<const std::size_t> all() const { return {all_.data(), count_}; }
  [[nodiscard]] std::span<const std::size_t> edges() const { return {all_.data(), edges_}; }

 private:
  std::array<std::size_t, 8> all_{};
  std::size_t count_ = 0;
  std::size_t edges_ = 0;
};

}  // namespace pillarfield
