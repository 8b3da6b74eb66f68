#pragma once

#include <numbers>

#include "pillarfield/skin.h"

namespace pillarfield {

/// Newtons per count of the direct solve, 1 / (2 sqrt(2) k) and 1 / (2 k)
/// (docs/derivations/direct_solve.md, D6).
struct ForceScale {
  double shear;
  double normal;
};

constexpr ForceScale force_scale(double counts_per_newton) {
  return {1 / (2 * std::numbers::sqrt2 * counts_per_newton), 1 / (2 * counts_per_newton)};
}

/// That of a skin; without pillars, of a sensel: 1 / k.
[[nodiscard]] inline ForceScale force_scale(const Skin& skin) {
  if (skin.has_pillars()) return force_scale(skin.counts_per_newton);
  return {0, 1 / skin.counts_per_newton};
}

}  // namespace pillarfield
