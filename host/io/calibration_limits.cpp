#include "io/calibration_limits.h"

#include <fmt/format.h>

#include <span>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

template <class T>
void check_plane(const std::vector<T>& plane, const Skin& skin, const char* where, const char* name,
                 double low, double high) {
  if (plane.empty()) return;
  if (plane.size() != skin.sensels()) {
    throw Error(where, fmt::format("{} has {} values", name, plane.size()),
                fmt::format("it needs one for each sensel, {} x {}", skin.rows, skin.cols));
  }
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const auto value = static_cast<double>(plane[i]);
    if (value >= low && value <= high) continue;
    throw Error(where,
                fmt::format("{} of sensel (row {}, column {}) is {}", name, i / skin.cols,
                            i % skin.cols, value),
                fmt::format("it must lie in [{}, {}]", low, high));
  }
}

}  // namespace

void check(const Calibration& calibration, const Skin& skin, const char* where) {
  check_plane(calibration.tare, skin, where, "tare", -kMaxCounts, kMaxCounts);
  check_plane(calibration.gain, skin, where, "gain", 1e-2, 1e2);
  check_plane(calibration.dead_zone, skin, where, "dead_zone", 0, kMaxCounts);
  check_plane(calibration.mask, skin, where, "mask", 0, 1);
}

}  // namespace pillarfield
