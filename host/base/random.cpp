#include "base/random.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace pillarfield::random {
namespace {

struct Product {
  std::uint32_t high;
  std::uint32_t low;
};

Product multiply(std::uint32_t a, std::uint32_t b) {
  const std::uint64_t product = std::uint64_t{a} * b;
  return {static_cast<std::uint32_t>(product >> 32), static_cast<std::uint32_t>(product)};
}

std::uint32_t low_word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
std::uint32_t high_word(std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); }

/// The words of sensels 4·block to 4·block + 3 of a row.
Block words_of(const Row& row, std::size_t block) {
  const Block counter = {(row.row << 16) | static_cast<std::uint32_t>(block),
                         static_cast<std::uint32_t>(row.stream), low_word(row.frame),
                         high_word(row.frame)};
  return philox(counter, {low_word(row.seed), high_word(row.seed)});
}

/// Two independent normal variates from two words.
std::array<float, 2> box_muller(std::uint32_t first, std::uint32_t second) {
  constexpr float kUnit = 0x1p-24F;
  const float uniform = static_cast<float>((first >> 8) + 1) * kUnit;  // (0, 1]
  const float angle = static_cast<float>(second >> 8) * (kUnit * 2 * std::numbers::pi_v<float>);
  const float radius = std::sqrt(-2 * std::log(uniform));
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

/// Calls `fill(words, part)` for each block of four sensels; the last part may be shorter.
template <class T, class Fill>
void for_each_block(const Row& row, std::span<T> values, Fill fill) {
  for (std::size_t first = 0; first < values.size(); first += 4) {
    fill(words_of(row, first / 4),
         values.subspan(first, std::min<std::size_t>(4, values.size() - first)));
  }
}

}  // namespace

Block philox(Block counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const Product a = multiply(0xD2511F53U, counter[0]);
    const Product b = multiply(0xCD9E8D57U, counter[2]);
    counter = {b.high ^ counter[1] ^ key[0], b.low, a.high ^ counter[3] ^ key[1], a.low};
    key[0] += 0x9E3779B9U;
    key[1] += 0xBB67AE85U;
  }
  return counter;
}

void fill_normal(const Row& row, std::span<float> values) {
  for_each_block(row, values, [](const Block& words, std::span<float> part) {
    const std::array<float, 2> left = box_muller(words[0], words[1]);
    const std::array<float, 2> right = box_muller(words[2], words[3]);
    const std::array<float, 4> all = {left[0], left[1], right[0], right[1]};
    std::copy_n(all.begin(), part.size(), part.begin());
  });
}

void fill_uniform(const Row& row, std::span<double> values) {
  for_each_block(row, values, [](const Block& words, std::span<double> part) {
    std::transform(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(part.size()),
                   part.begin(), [](std::uint32_t word) { return word * 0x1p-32; });
  });
}

}  // namespace pillarfield::random
