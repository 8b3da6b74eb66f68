#include "calibration/wire_correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/frame.h"
#include "pillarfield/solver_plan.h"
#include "skin/quads.h"
#include "skin/raw_reading.h"
#include "solve/pillar_maths.h"

namespace pillarfield {
namespace {

/// Factor on the full scale of corrected frames: the product of the largest gains of wires.
constexpr double kScaleReserve = 16;
/// Largest part of its voltage that a row may lose in frames of a calibration.
constexpr double kMostLoss = 0.2;

std::size_t tiles_along(std::size_t sensels, std::size_t tile) {
  return (sensels + tile - 1) / tile;
}

/// A reading less its offset, if there are some, for the sums; a missing sensel counts as zero.
float summed_reading(const SolverPlan& plan, const FrameView& frame, std::span<const float> offsets,
                     std::size_t row, std::size_t col) {
  if (row >= frame.rows || col >= frame.cols) return 0;
  const auto& mask = plan.calibration.mask;
  const std::size_t i = row * frame.cols + col;
  if (!mask.empty() && mask[i] != 1) return 0;
  const auto reading = raw_reading(frame, row, col);
  if (!(std::abs(reading) <= static_cast<float>(kMaxCounts))) return 0;
  return offsets.empty() ? reading : reading - offsets[i];
}

/// Factors by which the wires of a plan act on the readings of a frame, as
/// kernels/frame/find_wires.cl finds them; nothing if the plan has no crosstalk of wires.
class WireFactors {
 public:
  WireFactors() = default;
  /// `tares` are those of the frame; with TareOrigin::offset they do not load the wires.
  WireFactors(const SolverPlan& plan, const FrameView& frame, std::span<const float> tares);

  /// Wires of a sensel; meaningless outside the pillars, and without crosstalk.
  [[nodiscard]] single_precision::Wires at(std::size_t row, std::size_t col) const;

 private:
  /// Finds the factors of the tile whose first sensel is at (row, col).
  void find_tile(const SolverPlan& plan, const FrameView& frame, std::span<const float> offsets,
                 std::size_t row, std::size_t col);

  WireCrosstalk wires_;
  std::size_t rows_ = 0;  ///< sensels under pillars; 0: no crosstalk
  std::size_t cols_ = 0;
  std::vector<single_precision::RowWires> row_factors_;  ///< [tiles across, rows]
  std::vector<float> column_gains_;                      ///< [tiles down, columns]
};

WireFactors::WireFactors(const SolverPlan& plan, const FrameView& frame,
                         std::span<const float> tares) {
  if (!plan.calibration.effects.wires) return;
  const auto offsets =
      has_offset_tares(plan.calibration.effects) ? tares : std::span<const float>();
  wires_ = *plan.calibration.effects.wires;
  rows_ = 2 * std::size_t{quad_rows(plan.skin)};
  cols_ = 2 * std::size_t{quad_cols(plan.skin)};
  row_factors_.assign(rows_ * tiles_along(cols_, wires_.tile_cols), {1, 0});
  column_gains_.resize(cols_ * tiles_along(rows_, wires_.tile_rows));
  for (std::size_t row = 0; row < rows_; row += wires_.tile_rows) {
    for (std::size_t col = 0; col < cols_; col += wires_.tile_cols)
      find_tile(plan, frame, offsets, row, col);
  }
}

single_precision::Wires WireFactors::at(std::size_t row, std::size_t col) const {
  if (row >= rows_ || col >= cols_) return {};
  const auto& [gain, driven] = row_factors_[col / wires_.tile_cols * rows_ + row];
  return {gain, driven * gain, column_gains_[row / wires_.tile_rows * cols_ + col]};
}

void WireFactors::find_tile(const SolverPlan& plan, const FrameView& frame,
                            std::span<const float> offsets, std::size_t row, std::size_t col) {
  const single_precision::WireModel model = {static_cast<float>(wires_.row_per_count),
                                             static_cast<float>(wires_.column_per_count),
                                             static_cast<float>(wires_.idle_per_count)};
  const std::size_t rows = std::min<std::size_t>(wires_.tile_rows, rows_ - row);
  const std::size_t cols = std::min<std::size_t>(wires_.tile_cols, cols_ - col);
  const std::size_t padded = tiles_along(wires_.tile_cols, PF_WIRE_PARTS) * PF_WIRE_PARTS;
  std::vector<float> readings(padded);
  std::vector<float> columns(padded, 1);
  std::vector<float> losses(padded);
  const auto count = static_cast<int>(padded);
  for (int sweep = 0; sweep < PF_WIRE_SWEEPS; ++sweep) {
    for (std::size_t r = row; r < row + rows; ++r) {
      for (std::size_t c = 0; c < cols; ++c) {
        readings[c] = summed_reading(plan, frame, offsets, r, col + c);
      }
      auto& factors = row_factors_[col / wires_.tile_cols * rows_ + r];
      const auto [load, square] =
          single_precision::sums_of_row(readings.data(), columns.data(), count);
      factors = single_precision::wires_of_rows(load, square, factors, model);
      single_precision::add_row(readings.data(), losses.data(), count, factors.row, factors.driven,
                                model);
    }
    single_precision::find_columns(losses.data(), columns.data(), count);
  }
  const std::size_t first = row / wires_.tile_rows * cols_ + col;
  std::copy_n(columns.begin(), cols, column_gains_.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

WireCorrection::WireCorrection(std::string name, const Skin& skin, SenselType type,
                               const std::optional<WireCrosstalk>& wires, std::vector<float> tare)
    : name_(std::move(name)), skin_(skin) {
  plan_.skin = skin;
  plan_.sensel_type = type;
  plan_.calibration.effects.wires = wires;
  const bool offset = has_offset_tares(plan_.calibration.effects);
  if (!wires || (offset && tare.empty())) return;
  if (offset) plan_.calibration.tare = std::move(tare);
  if (skin_.full_scale_counts) *skin_.full_scale_counts *= kScaleReserve;
  corrected_.emplace(SenselType::f32, skin.rows, skin.cols);
}

float WireCorrection::corrected(float reading, std::size_t sensel,
                                const single_precision::Wires& at) const {
  const float tare = plan_.calibration.tare.empty() ? 0 : plan_.calibration.tare[sensel];
  single_precision::Sensel load{};
  load.reading = reading - tare;
  load = single_precision::remove_crosstalk(load, at);
  return load.missing != 0 ? std::nanf("") : tare + load.reading;
}

FrameView WireCorrection::operator()(const FrameView& raw) {
  const FrameView frame = unlimited(raw);
  const float kept = 1 / largest_gain_;
  if (kept >= 1 - kMostLoss) return frame;
  throw Error(name_,
              fmt::format("a row of sensels loses {:.1f} % of its voltage in the wires, more than "
                          "the {:.0f} % that a calibration can correct",
                          100 * (1 - kept), 100 * kMostLoss),
              "press less, or fewer sensels of a row at once");
}

FrameView WireCorrection::unlimited(const FrameView& raw) {
  if (!corrected_) return raw;
  largest_gain_ = 1;
  const WireFactors factors(plan_, raw, plan_.calibration.tare);
  const auto out = corrected_->readings<float>();
  for_each_row(raw, [&](std::size_t row, const auto* readings) {
    for (std::size_t col = 0; col < raw.cols; ++col) {
      const auto reading = static_cast<float>(readings[col]);
      const std::size_t i = row * raw.cols + col;
      const bool is_wired =
          row / 2 < plan_.skin.pillar_rows() && col / 2 < plan_.skin.pillar_cols();
      const single_precision::Wires at = factors.at(row, col);
      if (is_wired) largest_gain_ = std::max(largest_gain_, at.row);
      out[i] = is_wired ? corrected(reading, i, at) : reading;
      if (is_wired && plan_.skin.full_scale_counts && reading >= *plan_.skin.full_scale_counts) {
        out[i] = static_cast<float>(*skin_.full_scale_counts);
      }
    }
  });
  return corrected_->view();
}

}  // namespace pillarfield
