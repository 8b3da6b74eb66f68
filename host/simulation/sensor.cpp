#include "simulation/sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/random.h"
#include "base/wide.h"
#include "simulation/effects/memory_history.h"
#include "simulation/effects/sensel_leak.h"
#include "simulation/effects/wire_network.h"
#include "simulation/path_place.h"

namespace pillarfield {
namespace {

/// The elements of a plane that belong to a row of `signal`'s length.
template <class T>
std::span<const T> row_of(const std::vector<T>& plane, std::uint32_t row, std::size_t cols) {
  return std::span(plane).subspan(row * cols, cols);
}

/// A plane made row by row from standard normal variates.
template <class Map>
std::vector<float> normal_plane(const Scene& scene, random::Stream stream, Map map) {
  std::vector<float> plane(scene.skin.sensels());
  for (std::uint32_t row = 0; row < scene.skin.rows; ++row) {
    const auto values =
        std::span(plane).subspan(std::size_t{row} * scene.skin.cols, scene.skin.cols);
    random::fill_normal({scene.seed, stream, 0, row}, values);
    std::transform(values.begin(), values.end(), values.begin(),
                   [&](float variate) { return static_cast<float>(map(double{variate})); });
  }
  return plane;
}

/// Gain 1/g; sensitivities g are lognormal with mean 1 and the given standard deviation.
std::vector<float> draw_gains(const Scene& scene) {
  const double variance = std::log1p(scene.sensor.gain_spread * scene.sensor.gain_spread);
  const double deviation = std::sqrt(variance);
  return normal_plane(scene, random::Stream::sensitivity,
                      [=](double n) { return std::exp(variance / 2 - deviation * n); });
}

/// Normal tares, clipped at zero.
std::vector<float> draw_tares(const Scene& scene) {
  const SensorModel& model = scene.sensor;
  return normal_plane(scene, random::Stream::tare, [&](double n) {
    return std::max(0.0, model.tare_counts + model.tare_spread_counts * n);
  });
}

/// Drift rates in units of their standard deviation; empty without drift.
std::vector<float> draw_drift(const Scene& scene) {
  if (!(scene.sensor.drift_counts_per_s > 0)) return {};
  return normal_plane(scene, random::Stream::drift, [](double n) { return n; });
}

std::vector<std::uint8_t> draw_mask(const Scene& scene) {
  const std::uint32_t cols = scene.skin.cols;
  std::vector<std::uint8_t> mask;
  mask.reserve(scene.skin.sensels());
  std::vector<double> chance(cols);
  for (std::uint32_t row = 0; row < scene.skin.rows; ++row) {
    random::fill_uniform({scene.seed, random::Stream::dead, 0, row}, chance);
    for (const double value : chance) mask.push_back(value < scene.sensor.dead_share ? 0 : 1);
  }
  return mask;
}

Calibration draw_calibration(const Scene& scene) {
  const SensorModel& model = scene.sensor;
  Calibration calibration;
  if (model.tare_counts > 0 || model.tare_spread_counts > 0) calibration.tare = draw_tares(scene);
  if (model.gain_spread > 0) calibration.gain = draw_gains(scene);
  if (model.dead_zone_counts > 0) {
    calibration.dead_zone.assign(scene.skin.sensels(), static_cast<float>(model.dead_zone_counts));
  }
  if (model.dead_share > 0) calibration.mask = draw_mask(scene);
  if (scene.bending) {
    const auto pattern = [&](random::Stream stream) {
      return normal_plane(scene, stream,
                          [&](double n) { return scene.bending->spread_counts_mm * n; });
    };
    calibration.bend_x = pattern(random::Stream::bend_x);
    calibration.bend_y = pattern(random::Stream::bend_y);
    calibration.bend_xy = pattern(random::Stream::bend_xy);
  }
  calibration.effects = model.effects;
  return calibration;
}

PF_WIDE void add_scaled(std::span<const float> values, double factor, std::span<double> signal) {
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] += factor * values[i];
}

/// To the nearest whole count, halves up, within the converter's range.
template <class Count>
PF_WIDE_INLINE void round_each(std::span<const double> signal, double full_scale,
                               std::span<Count> out) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    // Avoids a library call per sensel; differs from lround just below a half.
    const double shifted = std::clamp(signal[i], 0.0, full_scale) + 0.5;
    out[i] = static_cast<Count>(static_cast<std::int32_t>(shifted));
  }
}

PF_WIDE void round_to(std::span<const double> signal, double full_scale,
                      std::span<std::uint8_t> out) {
  round_each(signal, full_scale, out);
}

PF_WIDE void round_to(std::span<const double> signal, double full_scale,
                      std::span<std::uint16_t> out) {
  round_each(signal, full_scale, out);
}

/// Curvature at a time: linear between keys, constant before the first and after the last.
CurvatureKey curvature_at(const std::vector<CurvatureKey>& path, double time_s) {
  const auto [from, to, fraction] = place_on(path, time_s);
  return {time_s, std::lerp(from.x, to.x, fraction), std::lerp(from.y, to.y, fraction),
          std::lerp(from.xy, to.xy, fraction)};
}

std::optional<PowerLaw> inverse(const std::optional<PowerLaw>& law) {
  if (!law) return std::nullopt;
  return PowerLaw{1 / law->exponent, law->reference_counts};
}

}  // namespace

Sensor::Sensor(const Scene& scene)
    : skin_(scene.skin),
      model_(scene.sensor),
      bending_(scene.bending),
      full_scale_counts_(
          scene.skin.full_scale_counts.value_or(std::numeric_limits<double>::infinity())),
      power_law_(inverse(scene.skin.power_law)),
      seed_(scene.seed),
      first_frame_of_noise_(std::uint64_t{scene.recording} << 32),
      rate_hz_(scene.rate_hz),
      calibration_(draw_calibration(scene)),
      drift_(draw_drift(scene)),
      needs_frames_(calibration_.effects.sensel_leak || calibration_.effects.wires ||
                    MemoryHistory::is_needed(model_)) {}

SenselType Sensor::sensel_type() const {
  if (!model_.adc_bits) return SenselType::f32;
  return *model_.adc_bits <= 8 ? SenselType::u8 : SenselType::u16;
}

void Sensor::load(std::span<double> frame_signal) const {
  subtract_dead_zone(frame_signal);
  if (const auto& leak = calibration_.effects.sensel_leak) {
    leak_between_sensels(*leak, skin_.rows, skin_.cols, frame_signal);
  }
}

void Sensor::read_frame(std::uint64_t frame, std::span<double> frame_signal,
                        FrameBuffer& raw) const {
  const auto row_signal = [&](std::uint32_t row) {
    return frame_signal.subspan(std::size_t{row} * skin_.cols, skin_.cols);
  };
  for (std::uint32_t row = 0; row < skin_.rows; ++row) respond(row, row_signal(row));
  const bool offset = has_offset_tares(calibration_.effects);
  const auto add_tares_to_frame = [&] {
    for (std::uint32_t row = 0; row < skin_.rows; ++row) add_tares(frame, row, row_signal(row));
  };
  if (!offset) add_tares_to_frame();
  if (const auto& wires = calibration_.effects.wires) {
    read_through_wires(*wires, skin_.rows, skin_.cols, frame_signal);
  }
  if (offset) add_tares_to_frame();
  for (std::uint32_t row = 0; row < skin_.rows; ++row) digitise(frame, row, row_signal(row), raw);
}

void Sensor::read_row(std::uint64_t frame, std::uint32_t row, std::span<double> signal,
                      FrameBuffer& raw) const {
  subtract_dead_zone(signal);
  respond(row, signal);
  add_tares(frame, row, signal);
  digitise(frame, row, signal, raw);
}

void Sensor::subtract_dead_zone(std::span<double> signal) const {
  if (!(model_.dead_zone_counts > 0)) return;
  // Uses the dead zone as rounded in the single-precision plane, so that readings are exact.
  const double dead_zone = calibration_.dead_zone.front();
  for (double& value : signal) value = std::max(0.0, value - dead_zone);
}

void Sensor::respond(std::uint32_t row, std::span<double> signal) const {
  if (power_law_) {
    for (double& value : signal) value = value > 0 ? straightened(*power_law_, value) : value;
  }
  if (const ResponseCurve& curve = model_.effects.curve; !curve.empty()) {
    for (double& value : signal) value = reading_at(curve, value);
  }
  if (!calibration_.gain.empty()) {
    const auto gain = row_of(calibration_.gain, row, signal.size());
    for (std::size_t i = 0; i < signal.size(); ++i) signal[i] /= gain[i];
  }
}

void Sensor::add_tares(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const {
  if (!calibration_.tare.empty()) {
    const auto tare = row_of(calibration_.tare, row, signal.size());
    for (std::size_t i = 0; i < signal.size(); ++i) signal[i] += tare[i];
  }
  if (bending_) add_bending(frame, row, signal);
}

void Sensor::add_bending(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const {
  const CurvatureKey curvature =
      curvature_at(bending_->path, static_cast<double>(frame) / rate_hz_);
  const auto x = row_of(calibration_.bend_x, row, signal.size());
  const auto y = row_of(calibration_.bend_y, row, signal.size());
  const auto xy = row_of(calibration_.bend_xy, row, signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) {
    signal[i] += curvature.x * x[i] + curvature.y * y[i] + curvature.xy * xy[i];
  }
}

void Sensor::digitise(std::uint64_t frame, std::uint32_t row, std::span<double> signal,
                      FrameBuffer& raw) const {
  if (!drift_.empty()) add_drift(frame, row, signal);
  if (model_.noise_counts > 0) add_noise(frame, row, signal);
  if (!calibration_.mask.empty()) clear_dead(row, signal);
  convert(row, signal, raw);
}

void Sensor::add_drift(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const {
  const auto speed = row_of(drift_, row, signal.size());
  const double spread_counts = model_.drift_counts_per_s * static_cast<double>(frame) / rate_hz_;
  add_scaled(speed, spread_counts, signal);
}

void Sensor::add_noise(std::uint64_t frame, std::uint32_t row, std::span<double> signal) const {
  std::vector<float> noise(signal.size());
  random::fill_normal({seed_, random::Stream::noise, frame + first_frame_of_noise_, row}, noise);
  add_scaled(noise, model_.noise_counts, signal);
}

void Sensor::clear_dead(std::uint32_t row, std::span<double> signal) const {
  const auto good = row_of(calibration_.mask, row, signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] = good[i] != 0 ? signal[i] : 0;
}

void Sensor::convert(std::uint32_t row, std::span<const double> signal, FrameBuffer& raw) const {
  const auto row_in = [&](auto readings) {
    return readings.subspan(row * signal.size(), signal.size());
  };
  switch (sensel_type()) {
    case SenselType::u8:
      round_to(signal, full_scale_counts_, row_in(raw.readings<std::uint8_t>()));
      return;
    case SenselType::u16:
      round_to(signal, full_scale_counts_, row_in(raw.readings<std::uint16_t>()));
      return;
    case SenselType::f32:
      break;
  }
  const auto out = row_in(raw.readings<float>());
  std::transform(signal.begin(), signal.end(), out.begin(), [&](double value) {
    return static_cast<float>(std::min(value, full_scale_counts_));
  });
}

}  // namespace pillarfield
