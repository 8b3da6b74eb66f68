#include "contacts/contact_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "pillarfield/status.h"

namespace pillarfield {
namespace {

bool operator==(const ContactSum& a, const ContactSum& b) {
  return a.shear_x == b.shear_x && a.shear_y == b.shear_y && a.normal == b.normal &&
         a.normal_x.value() == b.normal_x.value() && a.normal_y.value() == b.normal_y.value() &&
         a.shear_y_x.value() == b.shear_y_x.value() && a.shear_x_y.value() == b.shear_x_y.value() &&
         a.x == b.x && a.y == b.y && a.pillars == b.pillars && a.ambiguous == b.ambiguous &&
         a.resolved == b.resolved && a.peak == b.peak && a.peak_x == b.peak_x &&
         a.peak_y == b.peak_y;
}

struct Pillar {
  float shear_x;
  float shear_y;
  float normal;
  int x;
  int y;
  std::uint8_t status;
};

std::vector<Pillar> some_pillars(std::size_t count, float largest_n) {
  std::mt19937_64 random(count);
  std::uniform_real_distribution<float> force(-largest_n, largest_n);
  std::uniform_int_distribution<int> place(-2000, 2000);
  std::vector<Pillar> pillars(count);
  for (Pillar& pillar : pillars) {
    pillar = {force(random), force(random), std::abs(force(random)),
              place(random), place(random), static_cast<std::uint8_t>(random() & 0xff)};
  }
  return pillars;
}

PillarForce in_quanta(const ForceQuanta& quanta, const Pillar& pillar) {
  return {quanta.of(pillar.shear_x),
          quanta.of(pillar.shear_y),
          quanta.of(pillar.normal),
          pillar.x,
          pillar.y,
          pillar.status};
}

ContactSum sum_of(const std::vector<Pillar>& pillars) {
  const ForceQuanta quanta(pillars.size());
  ContactSum sum;
  for (const Pillar& pillar : pillars) sum.add(in_quanta(quanta, pillar));
  return sum;
}

TEST(ForceQuanta, RoundToTheNearestAndHoldTheRange) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const ForceQuanta quanta(25'000'000);
  EXPECT_EQ(quanta.largest_n(), 8192);
  EXPECT_EQ(quanta.of(1), 1 << 24);
  EXPECT_EQ(quanta.of(-0.25F), -(1 << 22));
  EXPECT_EQ(quanta.of(0x1p-25F * 1.01F), 1);
  EXPECT_EQ(quanta.of(0x1p-25F * 0.99F), 0);
  EXPECT_EQ(quanta.of(std::numeric_limits<float>::quiet_NaN()), 0);
  EXPECT_EQ(quanta.of(kInfinity), std::int64_t{1} << 37);
  EXPECT_EQ(quanta.of(-kInfinity), -(std::int64_t{1} << 37));
  EXPECT_EQ(quanta.of(3e38F), std::int64_t{1} << 37);
  EXPECT_EQ(ForceQuanta(1).largest_n(), 8192);
  EXPECT_EQ(ForceQuanta(32767ULL * 32767).largest_n(), 256);
}

TEST(ContactSum, IsTheSameBitsInAnyOrderAndGrouping) {
  for (const float largest_n : {0.5F, 9000.0F, 1e30F}) {
    std::vector<Pillar> pillars = some_pillars(5000, largest_n);
    const ContactSum expected = sum_of(pillars);
    std::mt19937_64 random(1);
    for (int turn = 0; turn < 10; ++turn) {
      std::shuffle(pillars.begin(), pillars.end(), random);
      EXPECT_TRUE(sum_of(pillars) == expected);
      ContactSum joined;
      const ForceQuanta quanta(pillars.size());
      for (std::size_t begin = 0; begin < pillars.size();) {
        const std::size_t end = std::min<std::size_t>(pillars.size(), begin + random() % 900);
        ContactSum part;
        for (; begin < end; ++begin) part.add(in_quanta(quanta, pillars[begin]));
        joined.add(part);
      }
      EXPECT_TRUE(joined == expected);
    }
  }
}

TEST(ContactSum, OfAMirroredContactIsMirrored) {
  std::vector<Pillar> pillars = some_pillars(3000, 2);
  const ContactSum sum = sum_of(pillars);
  for (Pillar& pillar : pillars) {
    pillar.x = -pillar.x;
    pillar.shear_x = -pillar.shear_x;
  }
  const ContactSum mirrored = sum_of(pillars);
  EXPECT_EQ(mirrored.shear_x, -sum.shear_x);
  EXPECT_EQ(mirrored.shear_y, sum.shear_y);
  EXPECT_EQ(mirrored.normal_x.value(), -sum.normal_x.value());
  EXPECT_EQ(mirrored.normal_y.value(), sum.normal_y.value());
  EXPECT_EQ(mirrored.shear_y_x.value(), -sum.shear_y_x.value());
  EXPECT_EQ(mirrored.shear_x_y.value(), -sum.shear_x_y.value());
  EXPECT_EQ(mirrored.x, -sum.x);
  EXPECT_EQ(mirrored.peak_x, -sum.peak_x);
}

/// Each force is at most half a quantum from its own.
TEST(ContactSum, IsWithinItsQuantumOfALongDoubleSum) {
  const std::vector<Pillar> pillars = some_pillars(40000, 0.5F);
  const ContactSum sum = sum_of(pillars);
  long double shear_x = 0;
  long double normal = 0;
  long double normal_x = 0;
  long double torque = 0;
  long double places = 0;
  for (const Pillar& pillar : pillars) {
    shear_x += pillar.shear_x;
    normal += pillar.normal;
    normal_x += static_cast<long double>(pillar.normal) * pillar.x;
    torque += static_cast<long double>(pillar.shear_y) * pillar.x -
              static_cast<long double>(pillar.shear_x) * pillar.y;
    places += std::abs(pillar.x) + std::abs(pillar.y);
  }
  constexpr long double kQuantum = ForceQuanta::kForceQuantum;
  const auto count = static_cast<long double>(pillars.size());
  const auto newtons = [&](auto quanta) { return static_cast<long double>(quanta) * kQuantum; };
  EXPECT_LE(std::abs(newtons(sum.shear_x) - shear_x), count * kQuantum / 2);
  EXPECT_LE(std::abs(newtons(sum.normal) - normal), count * kQuantum / 2);
  EXPECT_LE(std::abs(newtons(sum.normal_x.value()) - normal_x), places * kQuantum / 2);
  EXPECT_LE(std::abs(newtons(sum.shear_y_x.value() - sum.shear_x_y.value()) - torque),
            places * kQuantum / 2);
}

/// As if 2^25 - 1, and the most pillars that a skin can have, all bore the largest force at the
/// farthest place.
TEST(ContactSum, CannotOverflow) {
  for (const std::int64_t pillars : {(std::int64_t{1} << 25) - 1, std::int64_t{32767} * 32767}) {
    const ForceQuanta quanta(static_cast<std::uint64_t>(pillars));
    for (const float sign : {1.0F, -1.0F}) {
      const std::int64_t force = quanta.of(sign * 1e38F);
      EXPECT_LT(std::abs(static_cast<long double>(force)) * static_cast<long double>(pillars),
                9.2e18L);
      constexpr std::int64_t kFarthest = 32766;
      MomentSum doubled;
      doubled.add(force, kFarthest);
      // Adding a sum to itself stands for its pillars twice.
      std::int64_t stands_for = 1;
      for (; 2 * stands_for <= pillars; stands_for *= 2) doubled.add(MomentSum(doubled));
      const long double expected =
          static_cast<long double>(force) * kFarthest * static_cast<long double>(stands_for);
      EXPECT_EQ(static_cast<long double>(doubled.value()), expected);
      // The rest of the pillars fits too: each part is below half of what 63 bits hold.
      const auto low = static_cast<long double>((1 << 15) - 1) * kFarthest;
      const long double high = std::abs(std::floor(static_cast<long double>(force) / (1 << 15)));
      EXPECT_LT(low * static_cast<long double>(pillars), 9.2e18L);
      EXPECT_LT(high * kFarthest * static_cast<long double>(pillars), 9.2e18L);
    }
  }
}

TEST(ContactSum, CountsWhatIsAmbiguousAndResolved) {
  ContactSum sum;
  for (const int status : {0, 16, 128, 144, 15, 31}) {
    PillarForce pillar;
    pillar.status = static_cast<std::uint8_t>(status);
    sum.add(pillar);
  }
  EXPECT_EQ(sum.pillars, 6);
  EXPECT_EQ(sum.ambiguous, 4);
  EXPECT_EQ(sum.resolved, 2);
}

TEST(ContactSum, FirstOfEqualPeaksRowByRowCounts) {
  ContactSum sum;
  for (const auto& [x, y] : {std::pair{3, -3}, {1, 1}, {-1, 1}, {-3, -3}}) {
    PillarForce pillar;
    pillar.normal = 7;
    pillar.x = x;
    pillar.y = y;
    sum.add(pillar);
  }
  EXPECT_EQ(sum.peak_x, -1);
  EXPECT_EQ(sum.peak_y, 1);
}

}  // namespace
}  // namespace pillarfield
