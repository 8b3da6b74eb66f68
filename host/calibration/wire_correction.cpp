#include "calibration/wire_correction.h"

#include <cmath>

#include "skin/raw_reading.h"
#include "solve/pillar_maths.h"
#include "solve/wire_factors.h"

namespace pillarfield {
namespace {

/// Factor on the full scale of corrected frames: the product of the largest gains of wires.
constexpr double kScaleReserve = 16;

}  // namespace

WireCorrection::WireCorrection(const Skin& skin, SenselType type,
                               const std::optional<WireCrosstalk>& wires)
    : skin_(skin) {
  plan_.skin = skin;
  plan_.sensel_type = type;
  plan_.calibration.effects.wires = wires;
  if (!wires) return;
  if (skin_.full_scale_counts) *skin_.full_scale_counts *= kScaleReserve;
  corrected_.emplace(SenselType::f32, skin.rows, skin.cols);
}

FrameView WireCorrection::operator()(const FrameView& raw) {
  if (!corrected_) return raw;
  const WireFactors factors(plan_, raw);
  const auto out = corrected_->readings<float>();
  for_each_row(raw, [&](std::size_t row, const auto* readings) {
    for (std::size_t col = 0; col < raw.cols; ++col) {
      const auto reading = static_cast<float>(readings[col]);
      float& corrected = out[row * raw.cols + col];
      if (row / 2 >= plan_.skin.pillar_rows() || col / 2 >= plan_.skin.pillar_cols()) {
        corrected = reading;
        continue;
      }
      const single_precision::Wires at = factors.at(row, col);
      single_precision::Sensel sensel{};
      sensel.reading = reading;
      sensel = single_precision::remove_crosstalk(sensel, at);
      corrected = sensel.missing != 0 ? std::nanf("") : sensel.reading;
      if (plan_.skin.full_scale_counts && reading >= *plan_.skin.full_scale_counts) {
        corrected = static_cast<float>(*skin_.full_scale_counts);
      }
    }
  });
  return corrected_->view();
}

}  // namespace pillarfield
