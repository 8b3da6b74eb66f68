#include "simulation/indenter/height_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "simulation/indenter/indenter_history.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

using core_test::message_of;

std::filesystem::path scratch(const std::string& name) {
  return std::filesystem::path(testing::TempDir()) / ("pillarfield_" + name);
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

std::vector<std::byte> as_bytes(const std::string& text) {
  std::vector<std::byte> bytes(text.size());
  std::ranges::transform(text, bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  return bytes;
}

template <class Number>
std::string numbers_of(const std::vector<double>& values) {
  std::string bytes(values.size() * sizeof(Number), '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto number = static_cast<Number>(values[i]);
    std::memcpy(&bytes[i * sizeof number], &number, sizeof number);
  }
  return bytes;
}

/// As numpy.save() writes it, padded to 64 bytes.
std::string npy(const std::string& dictionary, const std::string& data) {
  std::string header = dictionary;
  header.append(63 - (10 + header.size()) % 64, ' ').push_back('\n');
  std::string file = "\x93NUMPY";
  file += {'\x01', '\0'};
  file.push_back(static_cast<char>(header.size() & 255U));
  file.push_back(static_cast<char>(header.size() >> 8U));
  return file + header + data;
}

std::string npy_of(const std::string& descr, const std::string& shape, const std::string& data) {
  return npy("{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }", data);
}

HeightMap parsed_npy(const std::string& file) { return parse_npy(as_bytes(file), "a.npy"); }

const std::vector<double> kSmall = {0, 1, 2, 3, 4, 5};

void expect_small(const HeightMap& map) {
  ASSERT_EQ(map.rows, 2U);
  ASSERT_EQ(map.cols, 3U);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(map.heights[i], kSmall[i] / 5);
}

TEST(HeightMap, ReadsArraysOfNumpy) {
  expect_small(parsed_npy(npy_of("<u2", "(2, 3)", numbers_of<std::uint16_t>(kSmall))));
  expect_small(parsed_npy(npy_of("<f8", "(2, 3)", numbers_of<double>(kSmall))));
  std::string swapped = numbers_of<double>(kSmall);
  for (std::size_t i = 0; i < 6; ++i) std::reverse(&swapped[8 * i], &swapped[8 * i] + 8);
  expect_small(parsed_npy(npy_of(">f8", "(2, 3)", swapped)));
  expect_small(parsed_npy(npy("{'shape': (2, 3), 'fortran_order': True, 'descr': '<f8'}",
                              numbers_of<double>({0, 3, 1, 4, 2, 5}))));
}

TEST(HeightMap, AFlatOneIsAllTop) {
  const HeightMap map = parsed_npy(npy_of("<f4", "(2, 2)", numbers_of<float>({7, 7, 7, 7})));
  EXPECT_EQ(map.heights, std::vector<double>(4, 1));
}

TEST(HeightMap, RefusesOtherFilesOfNumpyInOneLine) {
  const std::string six = numbers_of<double>(kSmall);
  const std::string save = "; save a two-dimensional array with numpy.save()";
  const std::string with_nan = numbers_of<double>({0, 1, 2, 3, std::nan(""), 5});
  const struct {
    std::string file;
    std::string message;
  } cases[] = {
      {npy_of("<f8", "(6,)", six), "has the shape 6" + save},
      {npy_of("<f8", "(2, 3, 1)", six), "has the shape 2 x 3 x 1" + save},
      {npy_of("<f8", "(1, 6)", six), "has 1 rows or columns, not 2 to 4096" + save},
      {npy_of("<f8", "(4096, 4097)", six), "has 4097 rows or columns, not 2 to 4096" + save},
      {npy_of("<f8", "(2, 4)", six),
       "has 48 bytes of numbers, not the 64 of its header; save the array again"},
      {npy_of("<f8", "(2, 3)", with_nan), "row 1, column 1 is nan; heights must be finite"},
  };
  for (const auto& [file, message] : cases) {
    EXPECT_EQ(message_of([&, text = file] { static_cast<void>(parsed_npy(text)); }),
              "a.npy: " + message);
  }
  EXPECT_TRUE(message_of([] { static_cast<void>(parsed_npy("root:x")); }).starts_with("a.npy: "));
}

/// A ball's relief, as a function of where a pixel's middle is.
std::vector<double> ball_relief(std::size_t side, double size_mm, double radius_mm) {
  std::vector<double> heights;
  for (std::size_t row = 0; row < side; ++row) {
    for (std::size_t col = 0; col < side; ++col) {
      const auto at = [&](std::size_t i) {
        return ((static_cast<double>(i) + 0.5) / static_cast<double>(side) - 0.5) * size_mm;
      };
      heights.push_back(std::sqrt(radius_mm * radius_mm - at(row) * at(row) - at(col) * at(col)));
    }
  }
  return heights;
}

constexpr std::size_t kMapSide = 201;
constexpr double kMapSizeMm = 20;
constexpr double kBallRadiusMm = 25;

Indenter map_indenter(const std::filesystem::path& file) {
  const std::vector<double> relief = ball_relief(kMapSide, kMapSizeMm, kBallRadiusMm);
  Indenter indenter;
  indenter.shape = IndenterShape::height_map;
  indenter.height_map = file;
  indenter.height_map_size_mm = {kMapSizeMm, kMapSizeMm};
  indenter.height_map_depth_mm = relief[kMapSide / 2 * kMapSide + kMapSide / 2] - relief[0];
  indenter.path = {{0, 0.7, -1.1, 30, 8}};
  return indenter;
}

IndenterForces forces_of(const Indenter& indenter) {
  Scene scene;
  scene.skin.rows = 44;
  scene.skin.cols = 44;
  scene.indenters = {indenter};
  return *IndenterHistory(scene, 0).forces(0);
}

void expect_like_ball(const Indenter& indenter, double tolerance_n) {
  Indenter ball;
  ball.radius_mm = kBallRadiusMm;
  ball.path = indenter.path;
  const IndenterForces expected = forces_of(ball);
  std::vector<double> all(484);
  for (const IndenterForce& force : forces_of(indenter)) all[force.pillar] = force.normal;
  double most = 0;
  for (const IndenterForce& force : expected) {
    most = std::max(most, force.normal);
    EXPECT_NEAR(all[force.pillar], force.normal, tolerance_n) << force.pillar;
  }
  EXPECT_GT(most, 50 * tolerance_n);
}

TEST(HeightMap, OfABallInNumpyPressesAsTheBall) {
  const auto file = scratch("ball.npy");
  write_bytes(file, npy_of("<f4", "(201, 201)",
                           numbers_of<float>(ball_relief(kMapSide, kMapSizeMm, kBallRadiusMm))));
  expect_like_ball(map_indenter(file), 2e-3);
  std::filesystem::remove(file);
}

TEST(HeightMap, OnlyRegularFilesWithAKnownEndingAreOpened) {
  const auto refused = [](const std::filesystem::path& path) {
    return message_of([&] { static_cast<void>(read_height_map(path)); });
  };
  EXPECT_EQ(refused("/nowhere/a.npy"), "/nowhere/a.npy: No such file or directory; check its name");
  EXPECT_EQ(refused("/dev/zero"), "/dev/zero: is not a height map; name a file that ends in .npy");
  const auto folder = scratch("folder.npy");
  std::filesystem::create_directory(folder);
  EXPECT_EQ(refused(folder), folder.string() + ": is a directory; name a file in it");
  std::filesystem::remove(folder);
}

}  // namespace
}  // namespace pillarfield
