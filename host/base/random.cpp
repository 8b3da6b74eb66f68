#include "base/random.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/wide.h"

namespace pillarfield::random {
namespace {

constexpr int kRounds = 10;
constexpr std::array<std::uint32_t, 2> kMultiplier = {0xD2511F53U, 0xCD9E8D57U};
constexpr std::array<std::uint32_t, 2> kKeyStep = {0x9E3779B9U, 0xBB67AE85U};

struct Product {
  std::uint32_t high;
  std::uint32_t low;
};

/// Two products, which compilers vectorise better than the halves of one.
constexpr Product multiply(std::uint32_t a, std::uint32_t b) {
  return {static_cast<std::uint32_t>((std::uint64_t{a} * b) >> 32), a * b};
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

/// Blocks of a row that are drawn together, one per lane; compilers turn loops over lanes into
/// vector instructions.
constexpr std::size_t kLanes = 16;
using Words = std::array<std::uint32_t, kLanes>;
using Variates = std::array<float, kLanes>;

/// philox() for kLanes counters.
PF_WIDE_INLINE void philox(std::array<Words, 4>& counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const Product a = multiply(counter[0][lane], kMultiplier[0]);
      const Product b = multiply(counter[2][lane], kMultiplier[1]);
      counter[0][lane] = b.high ^ counter[1][lane] ^ key[0];
      counter[1][lane] = b.low;
      counter[2][lane] = a.high ^ counter[3][lane] ^ key[1];
      counter[3][lane] = a.low;
    }
    for (std::size_t word = 0; word < 2; ++word) key[word] += kKeyStep[word];
  }
}

/// -ln(n / 2^24) for n in [1, 2^24], with a relative error of 3e-7: with n = m 2^e, m within a
/// factor of sqrt(2) of 1, and s = (m - 1) / (m + 1), ln m = 2 (s + s^3/3 + s^5/5 + ...).
PF_WIDE_INLINE float minus_log(std::uint32_t n) {
  constexpr auto kRootHalf = std::bit_cast<std::int32_t>(std::numbers::sqrt2_v<float> / 2);
  const auto bits = std::bit_cast<std::int32_t>(static_cast<float>(static_cast<std::int32_t>(n)));
  const std::int32_t exponent = (bits - kRootHalf) >> 23;
  const auto m = std::bit_cast<float>(bits - exponent * (1 << 23));
  const float s = (m - 1) / (m + 1);
  const float q = s * s;
  const float series = 1 + q * (1.0F / 3 + q * (1.0F / 5 + q * (1.0F / 7 + q * (1.0F / 9))));
  return static_cast<float>(24 - exponent) * std::numbers::ln2_v<float> - 2 * s * series;
}

/// Cosine and sine of word / 2^32 turns, with an absolute error of 2e-7: Taylor series within an
/// eighth of a turn of the nearest quarter.
PF_WIDE_INLINE void turn(std::uint32_t word, float& cosine, float& sine) {
  constexpr float kRadians = 2 * std::numbers::pi_v<float> * 0x1p-32F;
  const std::uint32_t quarter = (word + (1U << 29)) >> 30;
  const float x = static_cast<float>(static_cast<std::int32_t>(word - (quarter << 30))) * kRadians;
  const float q = x * x;
  const float along = 1 - q * (1.0F / 2 - q * (1.0F / 24 - q * (1.0F / 720 - q * (1.0F / 40320))));
  const float across = x * (1 - q * (1.0F / 6 - q * (1.0F / 120 - q * (1.0F / 5040))));
  const auto a = std::bit_cast<std::uint32_t>(along);
  const auto b = std::bit_cast<std::uint32_t>(across);
  const std::uint32_t swapped = (a ^ b) & (0 - (quarter & 1));
  cosine = std::bit_cast<float>((a ^ swapped) ^ (((quarter + 1) & 2) << 30));
  sine = std::bit_cast<float>((b ^ swapped) ^ ((quarter & 2) << 30));
}

/// Two independent normal variates from two words, by the method of Box and Muller with 24 bits of
/// each.
PF_WIDE_INLINE void box_muller(const Words& first, const Words& second, Variates& left,
                               Variates& right) {
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const float radius = std::sqrt(2 * minus_log((first[lane] >> 8) + 1));
    float cosine = 0;
    float sine = 0;
    turn(second[lane] & ~0xFFU, cosine, sine);
    left[lane] = radius * cosine;
    right[lane] = radius * sine;
  }
}

/// The variates of kLanes blocks from `block` on.
PF_WIDE void draw(const Row& row, std::size_t block, float* values) {
  std::array<Words, 4> words{};
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    words[0][lane] = (row.row << 16) | static_cast<std::uint32_t>(block + lane);
    words[1][lane] = static_cast<std::uint32_t>(row.stream);
    words[2][lane] = low_word(row.frame);
    words[3][lane] = high_word(row.frame);
  }
  philox(words, {low_word(row.seed), high_word(row.seed)});
  std::array<Variates, 4> variates{};
  box_muller(words[0], words[1], variates[0], variates[1]);
  box_muller(words[2], words[3], variates[2], variates[3]);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    for (std::size_t i = 0; i < 4; ++i) values[4 * lane + i] = variates[i][lane];
  }
}

}  // namespace

Block philox(Block counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const Product a = multiply(kMultiplier[0], counter[0]);
    const Product b = multiply(kMultiplier[1], counter[2]);
    counter = {b.high ^ counter[1] ^ key[0], b.low, a.high ^ counter[3] ^ key[1], a.low};
    for (std::size_t word = 0; word < 2; ++word) key[word] += kKeyStep[word];
  }
  return counter;
}

void fill_normal(const Row& row, std::span<float> values) {
  constexpr std::size_t kDrawn = 4 * kLanes;
  std::size_t first = 0;
  for (; first + kDrawn <= values.size(); first += kDrawn) draw(row, first / 4, &values[first]);
  if (first == values.size()) return;
  std::array<float, kDrawn> last{};
  draw(row, first / 4, last.data());
  std::copy_n(last.begin(), values.size() - first, &values[first]);
}

void fill_uniform(const Row& row, std::span<double> values) {
  for (std::size_t first = 0; first < values.size(); first += 4) {
    const Block words = words_of(row, first / 4);
    const std::size_t count = std::min<std::size_t>(4, values.size() - first);
    for (std::size_t i = 0; i < count; ++i) values[first + i] = words[i] * 0x1p-32;
  }
}

}  // namespace pillarfield::random
