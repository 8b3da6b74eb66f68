#include "lanes/calibration_memory.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "skin/quads.h"
#include "solve/activation_thresholds.h"

namespace pillarfield {
namespace {

/// Copies a plane, [sensel rows, cols], to memory for all sensels of quads; those that do not exist
/// get `otherwise`. Nothing if the plane is empty.
template <class Value>
void copy_values(const Skin& skin, const std::vector<Value>& plane, std::byte* to,
                 Value otherwise = 0) {
  if (plane.empty()) return;
  const std::size_t cols = padded_cols(skin);
  if (padded_sensels(skin) == plane.size()) {
    std::ranges::copy(std::as_bytes(std::span(plane)), to);
    return;
  }
  std::vector<Value> all(padded_sensels(skin), otherwise);
  for (std::size_t row = 0; row < skin.rows; ++row) {
    std::copy_n(plane.begin() + static_cast<std::ptrdiff_t>(row * skin.cols), skin.cols,
                all.begin() + static_cast<std::ptrdiff_t>(row * cols));
  }
  std::ranges::copy(std::as_bytes(std::span(all)), to);
}

/// Copies the activation thresholds as readings of a type.
void copy_activation_thresholds(const SolverPlan& plan, SenselType type, std::byte* to) {
  std::vector<float> levels = activation_thresholds(plan);
  if (levels.size() == 1) levels.resize(plan.skin.sensels(), levels.front());
  const auto never = static_cast<float>(activation_range(plan).never);
  const auto as = [&]<class Reading>(Reading) {
    copy_values(plan.skin, std::vector<Reading>(levels.begin(), levels.end()), to,
                static_cast<Reading>(never));
  };
  if (type == SenselType::u8) return as(std::uint8_t{});
  if (type == SenselType::u16) return as(std::uint16_t{});
  as(float{});
}

/// Writes a plane to zeroed memory; a plan that follows the baseline may start without a tare.
void copy_plane(const SolverPlan& plan, CalibrationPlane plane, SenselType thresholds,
                std::byte* to) {
  switch (plane) {
    case CalibrationPlane::tare:
      return copy_values(plan.skin, plan.calibration.tare, to);
    case CalibrationPlane::gain:
      return copy_values(plan.skin, plan.calibration.gain, to);
    case CalibrationPlane::dead_zone:
      return copy_values(plan.skin, plan.calibration.dead_zone, to);
    case CalibrationPlane::noise:
      return copy_values(plan.skin, plan.calibration.noise, to);
    case CalibrationPlane::mask:
      return copy_values(plan.skin, plan.calibration.mask, to, kAbsent);
    case CalibrationPlane::bend_x:
      return copy_values(plan.skin, plan.calibration.bend_x, to);
    case CalibrationPlane::bend_y:
      return copy_values(plan.skin, plan.calibration.bend_y, to);
    case CalibrationPlane::bend_xy:
      return copy_values(plan.skin, plan.calibration.bend_xy, to);
    case CalibrationPlane::release:
    case CalibrationPlane::release_after_odd:
    case CalibrationPlane::memory:
      return;
    case CalibrationPlane::activation:
      break;
  }
  copy_activation_thresholds(plan, thresholds, to);
}

/// Bytes of the states of pillars (Memory), as laid out in kernels/frame/memory_planes.h.
std::size_t bytes_of_states(const SolverPlan& plan) {
  const auto& memory = plan.calibration.effects.memory;
  if (!memory) return 0;
  const std::size_t words = 1 + 2 * (memory->plays.size() + memory->creep.size());
  // blocks_of_row() times the lanes, at most.
  const std::size_t pillars_of_row = std::size_t{quad_cols(plan.skin)} + 32;
  return page_aligned(words * quad_rows(plan.skin) * pillars_of_row * sizeof(std::uint32_t));
}

}  // namespace

std::vector<CalibrationPlane> calibration_planes(const SolverPlan& plan, bool has_activation) {
  const Calibration& calibration = plan.calibration;
  std::vector<CalibrationPlane> planes;
  const auto add = [&](bool wanted, CalibrationPlane plane) {
    if (wanted) planes.push_back(plane);
  };
  const bool bent = !calibration.bend_x.empty();
  add(!calibration.tare.empty() || plan.baseline_rate || bent, CalibrationPlane::tare);
  add(!calibration.gain.empty(), CalibrationPlane::gain);
  add(!calibration.dead_zone.empty(), CalibrationPlane::dead_zone);
  add(!calibration.noise.empty() && plan.uncertainty, CalibrationPlane::noise);
  add(!calibration.mask.empty(), CalibrationPlane::mask);
  add(has_activation, CalibrationPlane::activation);
  add(bent, CalibrationPlane::bend_x);
  add(bent, CalibrationPlane::bend_y);
  add(bent, CalibrationPlane::bend_xy);
  add(plan.baseline_rate.has_value(), CalibrationPlane::release);
  add(plan.baseline_rate.has_value(), CalibrationPlane::release_after_odd);
  add(calibration.effects.memory.has_value(), CalibrationPlane::memory);
  return planes;
}

CalibrationMemory::CalibrationMemory(const SolverPlan& plan, std::vector<CalibrationPlane> planes,
                                     SenselType thresholds)
    : planes_(std::move(planes)),
      stride_(padded_cols(plan.skin)),
      plane_bytes_(page_aligned(padded_sensels(plan.skin) * sizeof(float))),
      state_bytes_(bytes_of_states(plan)) {
  if (planes_.empty()) return;
  size_ = (planes_.size() - (state_bytes_ > 0 ? 1 : 0)) * plane_bytes_ + state_bytes_;
  memory_ = allocate_large_pages(size_);
  std::memset(memory_.get(), 0, size_);
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    copy_plane(plan, planes_[i], thresholds, memory_.get() + i * plane_bytes_);
  }
}

bool CalibrationMemory::has_tare() const {
  return !planes_.empty() && planes_.front() == CalibrationPlane::tare;
}

std::vector<float> CalibrationMemory::tare(std::size_t rows, std::size_t cols) const {
  std::vector<float> tare;
  const auto* const plane = reinterpret_cast<const float*>(memory_.get());
  for (std::size_t row = 0; row < rows; ++row) {
    tare.insert(tare.end(), plane + row * stride_, plane + row * stride_ + cols);
  }
  return tare;
}

}  // namespace pillarfield
