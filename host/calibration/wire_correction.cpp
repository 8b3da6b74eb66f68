#include "calibration/wire_correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "pillarfield/error.h"
#include "skin/raw_reading.h"
#include "solve/pillar_maths.h"
#include "solve/wire_factors.h"

namespace pillarfield {
namespace {

/// Factor on the full scale of corrected frames: the product of the largest gains of wires.
constexpr double kScaleReserve = 16;
/// Largest part of its voltage that a row may lose in frames of a calibration.
constexpr double kMostLoss = 0.2;

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
