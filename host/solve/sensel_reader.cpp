#include "solve/sensel_reader.h"

#include "pillarfield/tuning.h"

namespace pillarfield {

namespace maths = single_precision;

maths::Pillar SenselReader::pillar(std::size_t row, std::size_t col) const {
  const std::size_t top = 2 * row;
  const std::size_t left = 2 * col;
  return {sensel(top, left + 1), sensel(top, left), sensel(top + 1, left),
          sensel(top + 1, left + 1)};
}

maths::Noise SenselReader::noise(std::size_t row, std::size_t col) const {
  const std::size_t top = 2 * row;
  const std::size_t left = 2 * col;
  return {sensel_noise(top, left + 1), sensel_noise(top, left), sensel_noise(top + 1, left),
          sensel_noise(top + 1, left + 1)};
}

maths::Sensel SenselReader::validated(std::size_t row, std::size_t col) const {
  return maths::validate_reading(raw(row, col), correction(row, col).good, stages_);
}

maths::Sensel SenselReader::sensel(std::size_t row, std::size_t col) const {
  return maths::correct_sensel(raw(row, col), correction(row, col), stages_);
}

float SenselReader::sensel_noise(std::size_t row, std::size_t col) const {
  const float noise =
      calibration_.noise.empty() ? noise_ : calibration_.noise[row * frame_.cols + col];
  return maths::corrected_noise(noise, raw(row, col), correction(row, col), stages_);
}

maths::Correction SenselReader::correction(std::size_t row, std::size_t col) const {
  const std::size_t index = row * frame_.cols + col;
  const auto value = [index](const auto& plane) {
    return plane.empty() ? 0.0F : static_cast<float>(plane[index]);
  };
  return {value(calibration_.tare), value(calibration_.gain), value(calibration_.dead_zone),
          value(calibration_.mask)};
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
