#include "simulation/effects/sensel_leak.h"

#include <cstddef>
#include <vector>

#include "solve/sensor_corrections.h"

namespace pillarfield {

void leak_between_sensels(const SenselLeak& leak, std::uint32_t rows, std::uint32_t cols,
                          std::span<double> v) {
  // With a border of zeros every sensel has four neighbours.
  const std::size_t width = std::size_t{cols} + 2;
  std::vector<double> source((std::size_t{rows} + 2) * width);
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t col = 0; col < cols; ++col) {
      source[(row + 1) * width + col + 1] = v[row * cols + col];
    }
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const double above = leak_from(leak, static_cast<int>(row), -1);
    const double below = leak_from(leak, static_cast<int>(row), 1);
    for (std::size_t col = 0; col < cols; ++col) {
      const double left = leak_from(leak, static_cast<int>(col), -1);
      const double right = leak_from(leak, static_cast<int>(col), 1);
      const double* at = &source[(row + 1) * width + col + 1];
      v[row * cols + col] +=
          above * *(at - width) + below * at[width] + left * at[-1] + right * at[1];
    }
  }
}

}  // namespace pillarfield
