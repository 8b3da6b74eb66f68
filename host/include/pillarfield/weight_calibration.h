#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pillarfield/frame.h"
#include "pillarfield/sensel_finding.h"
#include "pillarfield/skin_calibration.h"

namespace pillarfield {

/// The result of WeightFinder. Deviations are standard deviations.
struct WeightResult {
  SkinCalibration calibration;
  std::vector<SenselFinding> findings;  ///< sensels that do not respond under the weight; masked
  std::vector<std::uint8_t> visited;    ///< [rows, cols]: 1 where the weight stood often enough

  std::size_t frames_used = 0;
  std::size_t places = 0;             ///< different sensels under the weight's centre
  std::size_t frames_saturated = 0;   ///< left out: a reading at full scale
  std::size_t frames_unreadable = 0;  ///< left out: a reading is not a number
  std::size_t frames_at_edge = 0;     ///< left out: on sensels beside the edge
  std::size_t frames_apart = 0;       ///< left out: far from the others, or disagree after the fit

  double exponent = 1;            ///< of the load in the reading: found, or that before
  double exponent_deviation = 0;  ///< of it
  bool finds_exponent = false;    ///< whether it is seen and stored

  double gain_spread = 0;     ///< of the visited sensels' gains, relative to those before
  double gain_deviation = 0;  ///< of a visited sensel's gain, relative, root mean square
  /// Deviation of an unvisited sensel's gain, relative: the spread between sensels.
  double unvisited_deviation = 0;
  double misfit = 0;         ///< of the sum of a frame beyond noise, relative
  double misfit_before = 0;  ///< the same with gains and response as before
  /// For totals of 0.3 to 2 times the heaviest weight anywhere, relative: 95 % lie within 1.96.
  double total_deviation = 0;
};

/// Finds gains, a power law and counts per newton from a known weight that is placed or rolled
/// anywhere over an array of sensels, each an element of its own (docs/calibration.md). Memory: 8
/// bytes a frame and sensel under the weight or beside it.
class WeightFinder {
 public:
  /// Throws Error if the calibration is of another skin, has no tare or noise, or has a memory.
  WeightFinder(const Skin& skin, const SkinCalibration& calibration);

  /// Begins a recording of a weight, N. Throws Error if it is not above zero.
  void begin(double weight_n, std::string name);

  /// Adds a frame of the skin's size.
  void add(const FrameView& frame);

  /// Throws Error if frames or places are too few, or their sums disagree.
  [[nodiscard]] WeightResult result() const;

  /// A frame with contact: corrected readings of the sensels above the threshold and beside them.
  struct Contact {
    std::size_t recording;
    std::size_t begin;  ///< of its sensels
    std::size_t end;
    bool saturated;  ///< in part: no load is known, but that it is there
  };

 private:
  struct Recording {
    std::string name;
    double weight_n;
  };

  Skin skin_;
  SkinCalibration calibration_;
  double threshold_ = 0;  ///< of a reading after the gain, counts
  std::vector<Recording> recordings_;
  std::vector<Contact> contacts_;
  std::vector<std::uint32_t> sensels_;
  std::vector<float> readings_;
  std::size_t saturated_ = 0;
  std::size_t unreadable_ = 0;
};

}  // namespace pillarfield
