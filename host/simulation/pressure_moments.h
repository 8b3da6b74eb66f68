#pragma once

#include <cstddef>
#include <vector>

namespace pillarfield {

/// First moments of the pressure on each pillar about its axis, N·mm: ∬ p (x, y) dA.
struct PressureMoments {
  PressureMoments() = default;
  explicit PressureMoments(std::size_t pillars) : x(pillars), y(pillars) {}

  [[nodiscard]] bool empty() const { return x.empty(); }

  std::vector<double> x;
  std::vector<double> y;
};

}  // namespace pillarfield
