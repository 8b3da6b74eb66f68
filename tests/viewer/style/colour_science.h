#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "viewer/style/colour_map.h"

/// Colour perception: CIELAB (D65), CIEDE2000, and colour blindness.
namespace pillarfield::viewer {

struct Lab {
  double lightness, a, b;
};
using Linear = std::array<double, 3>;  ///< linear sRGB, 0..1
using Matrix3 = std::array<std::array<double, 3>, 3>;

inline double linear_of(std::uint8_t byte) {
  const double share = byte / 255.0;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

inline Linear linear_of(Colour colour) {
  return {linear_of(colour.red), linear_of(colour.green), linear_of(colour.blue)};
}

inline Linear times(const Matrix3& matrix, const Linear& colour) {
  Linear product{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) product.at(i) += matrix.at(i).at(j) * colour.at(j);
  }
  return product;
}

inline Lab lab_of(const Linear& colour) {
  // IEC 61966-2-1; its white is where all three are 1.
  static constexpr Matrix3 kToXyz = {{{0.4124564, 0.3575761, 0.1804375},
                                      {0.2126729, 0.7151522, 0.0721750},
                                      {0.0193339, 0.1191920, 0.9503041}}};
  const auto root = [](double share) {
    constexpr double kCorner = 6.0 / 29;
    return share > kCorner * kCorner * kCorner ? std::cbrt(share)
                                               : share / (3 * kCorner * kCorner) + 4.0 / 29;
  };
  const Linear xyz = times(kToXyz, colour);
  const double x = root(xyz[0] / 0.95047);
  const double y = root(xyz[1]);
  const double z = root(xyz[2] / 1.08883);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

inline Lab lab_of(Colour colour) { return lab_of(linear_of(colour)); }

/// G. Sharma, W. Wu, E. N. Dalal, "The CIEDE2000 color-difference formula", Color Research and
/// Application 30 (2005).
inline double difference(Lab first, Lab second) {
  constexpr double kDegree = std::numbers::pi / 180;
  const auto strength = [](double chroma) {
    const double power = std::pow(chroma, 7);
    return std::sqrt(power / (power + std::pow(25.0, 7)));
  };
  const double mean_ab = (std::hypot(first.a, first.b) + std::hypot(second.a, second.b)) / 2;
  const double stretch = 1 + 0.5 * (1 - strength(mean_ab));
  const double chroma_1 = std::hypot(stretch * first.a, first.b);
  const double chroma_2 = std::hypot(stretch * second.a, second.b);
  const auto hue_of = [&](Lab lab) {
    const double hue = std::atan2(lab.b, stretch * lab.a) / kDegree;
    return hue < 0 ? hue + 360 : hue;
  };
  const double hue_1 = hue_of(first);
  const double hue_2 = hue_of(second);
  const bool grey = chroma_1 * chroma_2 == 0;
  const double turn = grey ? 0 : std::remainder(hue_2 - hue_1, 360);
  const double apart = std::abs(hue_1 - hue_2);
  double hue = (hue_1 + hue_2) / 2;
  if (grey) hue = hue_1 + hue_2;
  if (!grey && apart > 180) hue += hue < 180 ? 180 : -180;

  const double lightness = (first.lightness + second.lightness) / 2;
  const double chroma = (chroma_1 + chroma_2) / 2;
  const double shape =
      1 - 0.17 * std::cos((hue - 30) * kDegree) + 0.24 * std::cos(2 * hue * kDegree) +
      0.32 * std::cos((3 * hue + 6) * kDegree) - 0.20 * std::cos((4 * hue - 63) * kDegree);
  const double off_middle = (lightness - 50) * (lightness - 50);
  const double by_lightness =
      (second.lightness - first.lightness) / (1 + 0.015 * off_middle / std::sqrt(20 + off_middle));
  const double by_chroma = (chroma_2 - chroma_1) / (1 + 0.045 * chroma);
  const double by_hue = 2 * std::sqrt(chroma_1 * chroma_2) * std::sin(turn / 2 * kDegree) /
                        (1 + 0.015 * chroma * shape);
  const double blue = 30 * std::exp(-std::pow((hue - 275) / 25, 2));
  const double rotation = -std::sin(2 * blue * kDegree) * 2 * strength(chroma);
  return std::sqrt(by_lightness * by_lightness + by_chroma * by_chroma + by_hue * by_hue +
                   rotation * by_chroma * by_hue);
}

enum class Sight : std::uint8_t { normal, protanopia, deuteranopia, tritanopia };
inline constexpr std::array<Sight, 4> kSights = {Sight::normal, Sight::protanopia,
                                                 Sight::deuteranopia, Sight::tritanopia};

/// G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, "A Physiologically-based Model for Simulation
/// of Color Vision Deficiency", IEEE Transactions on Visualization and Computer Graphics 15 (2009):
/// severity 1.
inline const Matrix3& matrix_of(Sight sight) {
  static constexpr std::array<Matrix3, 4> kMatrices = {{
      {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
      {{{0.152286, 1.052583, -0.204868},
        {0.114503, 0.786281, 0.099216},
        {-0.003882, -0.048116, 1.051998}}},
      {{{0.367322, 0.860646, -0.227968},
        {0.280085, 0.672501, 0.047413},
        {-0.011820, 0.042940, 0.968881}}},
      {{{1.255528, -0.076749, -0.178779},
        {-0.078411, 0.930809, 0.147602},
        {0.004733, 0.691367, 0.303900}}},
  }};
  return kMatrices.at(static_cast<std::size_t>(sight));
}

inline Lab seen(Colour colour, Sight sight) {
  Linear changed = times(matrix_of(sight), linear_of(colour));
  for (double& share : changed) share = std::clamp(share, 0.0, 1.0);
  return lab_of(changed);
}

inline double difference(Colour first, Colour second, Sight sight = Sight::normal) {
  return difference(seen(first, sight), seen(second, sight));
}

}  // namespace pillarfield::viewer
