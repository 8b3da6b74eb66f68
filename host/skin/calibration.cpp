#include "pillarfield/calibration.h"

#include <fmt/format.h>

#include <algorithm>

#include "pillarfield/error.h"
#include "skin/pillar_sensels.h"
#include "skin/skin_fields.h"

namespace pillarfield {
namespace {

/// Throws Error unless a plane is empty or has one value in range per sensel. The limits are
/// rounded like the values: 0.01 is below itself as a float.
template <class Value>
void check_plane(const PlaneField& field, const std::vector<Value>& plane, const Skin& skin,
                 std::string_view where, double largest) {
  if (plane.empty()) return;
  const char* const name = field.name;
  const double low = field.low_for(largest);
  const double high = field.high_for(largest);
  if (plane.size() != skin.sensels()) {
    throw Error(where, fmt::format("calibration plane '{}' has {} values", name, plane.size()),
                fmt::format("the skin has {} x {} sensels", skin.rows, skin.cols));
  }
  for (std::size_t i = 0; i < plane.size(); ++i) {
    if (plane[i] >= static_cast<Value>(low) && plane[i] <= static_cast<Value>(high)) continue;
    throw Error(where,
                fmt::format("calibration plane '{}' is {} at row {}, column {}", name, plane[i],
                            i / skin.cols, i % skin.cols),
                fmt::format("it must lie in [{}, {}]", low, high));
  }
}

}  // namespace

std::size_t count_masked(const Calibration& calibration) {
  return static_cast<std::size_t>(std::ranges::count(calibration.mask, kMissing));
}

std::size_t count_absent(const Calibration& calibration) {
  return static_cast<std::size_t>(std::ranges::count(calibration.mask, kAbsent));
}

bool lacks_sensels(const Calibration& calibration, const Skin& skin, std::uint32_t row,
                   std::uint32_t col) {
  const auto is_absent = [&](std::size_t sensel) { return calibration.mask[sensel] == kAbsent; };
  if (calibration.mask.empty()) return false;
  if (!skin.has_pillars()) return is_absent(std::size_t{row} * skin.cols + col);
  return std::ranges::all_of(pillar_sensels(skin, row, col), is_absent);
}

std::size_t count_absent_elements(const Calibration& calibration, const Skin& skin) {
  if (!skin.has_pillars()) return count_absent(calibration);
  std::size_t count = 0;
  for_each_pillar(skin, [&](auto row, auto col, const auto&) {
    if (lacks_sensels(calibration, skin, row, col)) ++count;
  });
  return count;
}

double largest_plane_counts(SenselType type) {
  switch (type) {
    case SenselType::u8:
      return 255;
    case SenselType::u16:
      return 65535;
    case SenselType::f32:
      break;
  }
  return kMaxPlaneCounts;
}

void check(const Calibration& calibration, const Skin& skin, std::string_view where,
           std::optional<SenselType> type) {
  const double largest = largest_plane_counts(type.value_or(SenselType::f32));
  visit_planes(calibration, [&](const PlaneField& field, const auto& plane) {
    check_plane(field, plane, skin, where, largest);
  });
  if (calibration.bend_x.empty() != calibration.bend_y.empty() ||
      calibration.bend_x.empty() != calibration.bend_xy.empty()) {
    throw Error(where, "only some of the planes bend_x, bend_y and bend_xy are given",
                "give all three or none");
  }
  check(calibration.effects, where);
}

}  // namespace pillarfield
