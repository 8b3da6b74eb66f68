#include "core/sensel_reader.h"

namespace pillarfield {

namespace maths = single_precision;

maths::Sensel SenselReader::operator()(std::size_t row, std::size_t col) const {
  const Calibration& calibration = plan_.calibration;
  const Skin& skin = plan_.skin;
  const std::size_t index = row * frame_.cols + col;
  maths::Sensel sensel = maths::raw_sensel(raw(row, col));
  if (frame_.type == SenselType::f32) {
    sensel = maths::reject_absurd(sensel, static_cast<float>(kMaxCounts));
  }
  if (!calibration.mask.empty()) sensel = maths::apply_mask(sensel, calibration.mask[index]);
  if (skin.full_scale_counts) {
    sensel = maths::mark_saturated(sensel, static_cast<float>(*skin.full_scale_counts));
  }
  if (!calibration.tare.empty()) sensel = maths::subtract_tare(sensel, calibration.tare[index]);
  if (!calibration.gain.empty()) sensel = maths::apply_gain(sensel, calibration.gain[index]);
  if (const auto& law = skin.power_law) {
    sensel = maths::apply_power_law(sensel, static_cast<float>(law->exponent),
                                    static_cast<float>(law->reference_counts),
                                    static_cast<float>(kMaxCounts));
  }
  sensel = maths::classify(sensel, static_cast<float>(skin.threshold_counts));
  if (!calibration.dead_zone.empty()) {
    sensel = maths::fill_dead_zone(sensel, calibration.dead_zone[index]);
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

float SenselReader::noise(const maths::Sensel& sensel, std::size_t row, std::size_t col) const {
  const Calibration& calibration = plan_.calibration;
  const std::size_t index = row * frame_.cols + col;
  const float raw_noise = calibration.noise.empty() ? static_cast<float>(reading_noise(plan_))
                                                    : calibration.noise[index];
  const float noise = calibration.gain.empty() ? raw_noise : raw_noise * calibration.gain[index];
  const auto& law = plan_.skin.power_law;
  if (!law) return noise;
  const float dead_zone = calibration.dead_zone.empty() ? 0 : calibration.dead_zone[index];
  return noise * maths::power_law_slope(sensel.reading - dead_zone,
                                        static_cast<float>(law->exponent),
                                        static_cast<float>(law->reference_counts));
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
