#include "tests/viewer/app/made_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "viewer/source/selection.h"

namespace pillarfield::viewer {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNoiseCounts = 1.5;

double place_of(std::size_t sensel) { return kPi / 4 * (2 * static_cast<double>(sensel) + 1); }

struct Force {
  double x = 0, y = 0, normal = 0;
};

/// Force under a ball in partial slip.
Force force_at(double row, double col) {
  const double right = (col - 21) / 13;
  const double up = (14 - row) / 11;
  const double away = std::hypot(right, up);
  if (away >= 1) return {};
  const double normal = 0.3 * std::sqrt(1 - away * away);
  const double grip = 0.05 + 1.5 * away * away * away;
  return {normal * (-0.35 * grip - 0.5 * up), normal * (-0.85 * grip + 0.5 * right), normal};
}

/// Equation (2), in newtons.
std::array<double, 4> model_of(const Force& force) {
  std::array<double, 4> readings{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double angle = place_of(i);
    readings[i] = force.normal + force.x * std::cos(angle) + force.y * std::sin(angle);
  }
  return readings;
}

/// Region 3: the force at `normal` on the feasible segment of the two readings.
Force on_segment(const std::array<double, 4>& readings, std::size_t sensel, double normal) {
  Force force{0, 0, normal};
  for (const std::size_t each : {sensel, (sensel + 1) % 4}) {
    force.x += (readings[each] - normal) * std::cos(place_of(each));
    force.y += (readings[each] - normal) * std::sin(place_of(each));
  }
  return force;
}

Direction direction_of(const Force& force) {
  return viewer::direction_of(static_cast<float>(force.x), static_cast<float>(force.y),
                              static_cast<float>(force.normal));
}

void set_ends(ForceField& forces, std::size_t at, const Direction& low, const Direction& high) {
  forces.uncertainty[Uncertainty::theta_low][at] = std::min(low.theta, high.theta);
  forces.uncertainty[Uncertainty::theta_high][at] = std::max(low.theta, high.theta);
  const bool wraps = std::abs(low.phi - high.phi) > static_cast<float>(kPi);
  const float first = std::min(low.phi, high.phi);
  const float last = std::max(low.phi, high.phi);
  forces.uncertainty[Uncertainty::phi_low][at] = wraps ? last : first;
  forces.uncertainty[Uncertainty::phi_high][at] = wraps ? first : last;
  forces.uncertainty[Uncertainty::magnitude_low][at] = std::min(low.magnitude, high.magnitude);
  forces.uncertainty[Uncertainty::magnitude_high][at] = std::max(low.magnitude, high.magnitude);
}

void set_deviations(ForceField& forces, std::size_t at, double noise_n) {
  const auto shear = static_cast<float>(noise_n / std::sqrt(2));
  forces.uncertainty[Uncertainty::shear_x][at] = shear;
  forces.uncertainty[Uncertainty::shear_y][at] = shear;
  forces.uncertainty[Uncertainty::normal][at] = static_cast<float>(noise_n / 2);
}

std::uint8_t status_of(const std::array<double, 4>& read, double threshold_n) {
  std::uint8_t state = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (read[i] > threshold_n) state = static_cast<std::uint8_t>(state | 1u << i);
  }
  return state;
}

}  // namespace

MadeField::MadeField() : forces(32, 40) {
  skin.rows = 64;
  skin.cols = 80;
  skin.threshold_counts = 6;
  skin.full_scale_counts = 255;
  for (auto* plane : {&magnitude, &theta, &phi}) plane->resize(forces.elements());
  for (auto& plane : forces.uncertainty) plane.resize(forces.elements());
  readings.resize(skin.sensels());
  for (std::uint32_t row = 0; row < forces.rows; ++row) {
    for (std::uint32_t col = 0; col < forces.cols; ++col) set_pillar({row, col});
  }
}

std::array<double, 4> MadeField::read(PillarIndex pillar, const std::array<double, 4>& model) {
  std::array<double, 4> read{};
  for (std::size_t i = 0; i < 4; ++i) {
    const double counts = std::clamp(std::round(model[i] * skin.counts_per_newton), 0.0, 255.0);
    const std::size_t row = std::size_t{2} * pillar.row + (i < 2 ? 0 : 1);
    const std::size_t col = std::size_t{2} * pillar.col + (i == 0 || i == 3 ? 1 : 0);
    readings[row * skin.cols + col] = static_cast<std::uint16_t>(counts);
    read[i] = counts / skin.counts_per_newton;
  }
  return read;
}

void MadeField::set_pillar(PillarIndex pillar) {
  const std::size_t at = std::size_t{pillar.row} * forces.cols + pillar.col;
  Force force = force_at(pillar.row, pillar.col);
  const auto read = this->read(pillar, model_of(force));
  std::uint8_t state = status_of(read, skin.threshold_counts / skin.counts_per_newton);
  Direction low = direction_of(force);
  Direction high = low;
  for (std::size_t i = 0; i < 4; ++i) {
    if (state != (1u << i | 1u << (i + 1) % 4)) continue;
    state |= status::kAmbiguous;
    const double most = std::min(read[i], read[(i + 1) % 4]) / 2;
    force = on_segment(read, i, most / 2);
    low = direction_of(on_segment(read, i, 0));
    high = direction_of(on_segment(read, i, most));
    break;
  }
  if (state == 0) force = {};
  const Direction direction = direction_of(force);
  forces.shear_x[at] = static_cast<float>(force.x);
  forces.shear_y[at] = static_cast<float>(force.y);
  forces.normal[at] = static_cast<float>(force.normal);
  forces.status[at] = state;
  magnitude[at] = direction.magnitude;
  theta[at] = direction.theta;
  phi[at] = direction.phi;
  set_deviations(forces, at, kNoiseCounts / skin.counts_per_newton);
  set_ends(forces, at, low, high);
}

ShownField MadeField::shown() const {
  ShownField field;
  field.forces = forces.view();
  field.forces.magnitude = magnitude;
  field.forces.theta = theta;
  field.forces.phi = phi;
  field.raw = {readings.data(), SenselType::u16, skin.rows, skin.cols, skin.cols};
  field.time_s = 4;
  field.index = 400;
  return field;
}

SourceInfo MadeField::source() const {
  SourceInfo info;
  info.name = "made.toml";
  info.kind = "scene";
  info.skin = skin;
  info.frames = 600;
  info.has_readings = info.has_angles = info.has_uncertainty = true;
  return info;
}

}  // namespace pillarfield::viewer
