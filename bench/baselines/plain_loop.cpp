// Compiled with -O3 -march=native (bench/CMakeLists.txt).

#include "bench/baselines/bare_solve.h"
#include "solve/pillar_maths.h"

namespace pillarfield::bench {

namespace maths = single_precision;

void solve_rows_plainly(const BareSolve& solve, const FrameView& frame, std::uint32_t first,
                        std::uint32_t last, const ForcePlanes& to) {
  const auto* const readings = static_cast<const std::uint8_t*>(frame.data);
  const std::uint32_t cols = frame.cols / 2;
  const maths::ForceScale scale = {solve.shear_scale, solve.normal_scale};
  const auto sensel = [&](std::uint8_t raw) {
    return maths::classify(maths::raw_sensel(raw), solve.threshold);
  };
  for (std::size_t row = first; row < last; ++row) {
    const std::uint8_t* const top = readings + 2 * row * frame.row_stride;
    const std::uint8_t* const bottom = top + frame.row_stride;
    for (std::size_t col = 0; col < cols; ++col) {
      const maths::Pillar pillar = {sensel(top[2 * col + 1]), sensel(top[2 * col]),
                                    sensel(bottom[2 * col]), sensel(bottom[2 * col + 1])};
      const maths::Diagonals diagonals = maths::pillar_diagonals(pillar);
      const maths::ParitySum sum = maths::parity_sum(diagonals, static_cast<float>(kSegmentPoint));
      const maths::Force force = maths::direct_force(diagonals, sum, scale);
      const std::size_t index = row * cols + col;
      to.shear_x[index] = force.shear_x;
      to.shear_y[index] = force.shear_y;
      to.normal[index] = force.normal;
      to.status[index] =
          static_cast<std::uint8_t>(maths::direct_status(pillar, diagonals, sum, solve.margin));
    }
  }
}

}  // namespace pillarfield::bench
