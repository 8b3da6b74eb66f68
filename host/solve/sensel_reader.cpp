#include "solve/sensel_reader.h"

#include "pillarfield/tuning.h"

namespace pillarfield {

namespace maths = single_precision;

maths::Sensel SenselReader::operator()(std::size_t row, std::size_t col) const {
  const Calibration& calibration = plan_.calibration;
  maths::Sensel sensel = corrected(row, col);
  sensel = maths::classify(sensel, static_cast<float>(plan_.skin.threshold_counts));
  if (!calibration.dead_zone.empty()) {
    sensel = maths::fill_dead_zone(sensel, calibration.dead_zone[row * frame_.cols + col]);
  }
  return sensel;
}

maths::Pillar SenselReader::pillar(std::size_t row, std::size_t col) const {
  const std::size_t top = 2 * row;
  const std::size_t left = 2 * col;
  const SenselReader& sensel = *this;
  return {sensel(top, left + 1), sensel(top, left), sensel(top + 1, left),
          sensel(top + 1, left + 1)};
}

maths::Sensel SenselReader::judged(std::size_t row, std::size_t col) const {
  const Calibration& calibration = plan_.calibration;
  const std::size_t index = row * frame_.cols + col;
  maths::Sensel sensel = maths::raw_sensel(raw(row, col));
  if (frame_.type == SenselType::f32) {
    sensel = maths::reject_absurd(sensel, static_cast<float>(kMaxCounts));
  }
  if (!calibration.mask.empty()) sensel = maths::apply_mask(sensel, calibration.mask[index]);
  if (plan_.skin.full_scale_counts) {
    sensel = maths::mark_saturated(sensel, static_cast<float>(*plan_.skin.full_scale_counts));
  }
  return sensel;
}

float SenselReader::noise(std::size_t row, std::size_t col) const {
  const Calibration& calibration = plan_.calibration;
  const std::size_t index = row * frame_.cols + col;
  float noise = calibration.noise.empty() ? static_cast<float>(reading_noise(plan_))
                                          : calibration.noise[index];
  if (!calibration.gain.empty()) noise = noise * calibration.gain[index];
  if (!plan_.skin.power_law) return noise;
  float reading = raw(row, col);
  if (!calibration.tare.empty()) reading = reading - calibration.tare[index];
  if (!calibration.gain.empty()) reading = reading * calibration.gain[index];
  return noise * maths::power_law_slope(reading, exponent(), reference());
}

/// Up to the classification.
maths::Sensel SenselReader::corrected(std::size_t row, std::size_t col) const {
  const Calibration& calibration = plan_.calibration;
  const std::size_t index = row * frame_.cols + col;
  maths::Sensel sensel = judged(row, col);
  if (!calibration.tare.empty()) sensel = maths::subtract_tare(sensel, calibration.tare[index]);
  if (!calibration.gain.empty()) sensel = maths::apply_gain(sensel, calibration.gain[index]);
  if (!plan_.skin.power_law) return sensel;
  return maths::apply_power_law(sensel, exponent(), reference(), static_cast<float>(kMaxCounts));
}

float SenselReader::exponent() const { return static_cast<float>(plan_.skin.power_law->exponent); }

float SenselReader::reference() const {
  return static_cast<float>(plan_.skin.power_law->reference_counts);
}

float SenselReader::raw(std::size_t row, std::size_t col) const {
  const std::size_t index = row * frame_.row_stride + col;
  switch (frame_.type) {
    case SenselType::u8:
      return static_cast<const std::uint8_t*>(frame_.data)[index];
    case SenselType::u16:
      return static_cast<const std::uint16_t*>(frame_.data)[index];
    case SenselType::f32:
      break;
  }
  return static_cast<const float*>(frame_.data)[index];
}

}  // namespace pillarfield
