// The frames in which a known weight stands wholly on an array of sensels.

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "calibration/neighbours.h"
#include "calibration/weight_fit.h"
#include "pillarfield/calibration.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin.h"
#include "pillarfield/weight_calibration.h"

namespace pillarfield {

/// The value of Calibration::mask.
[[nodiscard]] inline std::uint8_t state_of(const Calibration& planes, std::size_t sensel) {
  return planes.mask.empty() ? kGood : planes.mask[sensel];
}

/// The contacts that a WeightFinder has collected.
struct WeightContacts {
  const Skin& skin;
  double threshold;  ///< of a reading
  std::span<const WeightFinder::Contact> contacts;
  std::span<const std::uint32_t> sensels;
  std::span<const float> readings;
};

/// Sensels that never read between pressed ones.
[[nodiscard]] std::vector<SenselFinding> unresponsive_sensels(const WeightContacts& all,
                                                              const Calibration& planes);

/// 1 for each sensel, and the part of missing ones beside it for which it stands.
[[nodiscard]] std::vector<double> copies_of(const Calibration& planes, const Skin& skin);

/// Frames whose weight stands wholly on the array, and what was left out.
struct WeightSelection {
  std::vector<WeighedFrame> frames;
  std::size_t at_edge = 0;  ///< partly on sensels beside the edge
  std::size_t apart = 0;    ///< with sums far from the others
  std::size_t places = 0;   ///< different sensels under the centre
};

/// `weights_n` are those of the recordings.
[[nodiscard]] WeightSelection select_frames(const WeightContacts& all, const Calibration& planes,
                                            std::span<const double> weights_n);

}  // namespace pillarfield
