#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace pillarfield {

/// Counter-based random numbers: a function of seed, stream, frame and sensel, without state, so
/// they can be drawn in any order and on any thread.
///
/// Philox 4x32-10 (J. K. Salmon et al., Parallel random numbers: as easy as 1, 2, 3, SC 2011) with
/// the seed as key.
namespace random {

using Block = std::array<std::uint32_t, 4>;

/// Philox 4x32-10: four random words for a counter and a key.
[[nodiscard]] Block philox(Block counter, std::array<std::uint32_t, 2> key);

/// Purpose of random numbers; different streams are independent.
enum class Stream : std::uint32_t {
  sensitivity,
  tare,
  dead,
  noise,
  drift,
  roughness = 7,  ///< 5 and 6 served a simulation that is gone; recordings keep their noise
  friction,
  bend_x,
  bend_y,
  bend_xy,
};

/// A row of sensels in a frame.
struct Row {
  std::uint64_t seed;
  Stream stream;
  std::uint64_t frame;
  std::uint32_t row;  ///< below 65536
};

/// Standard normal variates, one per sensel of a row of at most 2^18, by the Box-Muller method in
/// single precision: at most 5.77 in magnitude, within 1e-6. About 2 ns each.
void fill_normal(const Row& row, std::span<float> values);

/// Uniform variates in [0, 1), multiples of 2^-32.
void fill_uniform(const Row& row, std::span<double> values);

}  // namespace random
}  // namespace pillarfield
