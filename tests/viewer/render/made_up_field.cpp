#include "tests/viewer/render/made_up_field.h"

#include <cmath>
#include <memory>
#include <new>
#include <vector>

namespace pillarfield::viewer {
namespace {

constexpr std::size_t kPage = 4096;

std::size_t whole_pages(std::size_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }

std::shared_ptr<std::byte[]> make_pages(std::size_t bytes) {
  auto* const pages = static_cast<std::byte*>(::operator new[](bytes, std::align_val_t{kPage}));
  return {pages, [](std::byte* memory) { ::operator delete[](memory, std::align_val_t{kPage}); }};
}

/// Readings of the pillar model under a force, k = 100 counts per newton.
std::array<float, 4> readings_of(const MadeUpPillar& pillar) {
  const float k = 100;
  const float a = std::sqrt(0.5F);
  const float rising = a * (pillar.shear_x + pillar.shear_y);
  const float falling = a * (pillar.shear_y - pillar.shear_x);
  return {k * (pillar.normal + rising), k * (pillar.normal + falling), k * (pillar.normal - rising),
          k * (pillar.normal - falling)};
}

constexpr std::size_t kFloatPlanes = 6 + kUncertaintyPlanes;

/// Values of a pillar in the float planes, in their order.
std::array<float, kFloatPlanes> planes_of(const MadeUpPillar& pillar, std::size_t index) {
  const float shear = std::hypot(pillar.shear_x, pillar.shear_y);
  const float magnitude = std::hypot(shear, pillar.normal);
  const float theta = std::atan2(shear, pillar.normal);
  const float phi = std::atan2(-pillar.shear_y, -pillar.shear_x);
  const float deviation = 0.01F * static_cast<float>(1 + index % 29);
  return {pillar.shear_x,  pillar.shear_y,
          pillar.normal,   magnitude,
          theta,           phi,
          deviation,       0.02F,
          0.02F,           theta - 0.3F,
          theta + 0.1F,    phi - 0.4F,
          phi + 0.4F,      magnitude * 0.8F,
          magnitude * 1.2F};
}

void set_readings(FrameBuffer& raw, std::size_t row, std::size_t col, const MadeUpPillar& pillar) {
  const auto readings = readings_of(pillar);
  const auto at = [&](std::size_t r, std::size_t c) -> float& {
    return raw.readings<float>()[(2 * row + r) * raw.view().cols + 2 * col + c];
  };
  at(0, 1) = readings[0];
  at(0, 0) = readings[1];
  at(1, 0) = readings[2];
  at(1, 1) = readings[3];
}

}  // namespace

MadeUpField::MadeUpField(std::uint32_t rows, std::uint32_t cols, const Pillar& pillar) {
  const std::size_t pillars = std::size_t{rows} * cols;
  const std::size_t plane_bytes = whole_pages(pillars * sizeof(float));
  const std::size_t bytes = kFloatPlanes * plane_bytes + whole_pages(pillars);
  const auto pages = make_pages(bytes);
  const auto floats = [&](std::size_t plane) {
    return std::span(reinterpret_cast<float*>(pages.get() + plane * plane_bytes), pillars);
  };
  auto* const status = reinterpret_cast<std::uint8_t*>(pages.get() + kFloatPlanes * plane_bytes);
  auto raw = std::make_shared<FrameBuffer>(SenselType::f32, 2 * rows, 2 * cols);
  for (std::size_t index = 0; index < pillars; ++index) {
    const std::size_t row = index / cols;
    const std::size_t col = index % cols;
    const MadeUpPillar value =
        pillar(static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(col));
    const auto planes = planes_of(value, index);
    for (std::size_t plane = 0; plane < planes.size(); ++plane) {
      floats(plane)[index] = planes.at(plane);
    }
    status[index] = value.status;
    set_readings(*raw, row, col, value);
  }

  ForceFieldView& forces = shown_.forces;
  forces.rows = rows;
  forces.cols = cols;
  forces.shear_x = floats(0);
  forces.shear_y = floats(1);
  forces.normal = floats(2);
  forces.magnitude = floats(3);
  forces.theta = floats(4);
  forces.phi = floats(5);
  std::size_t plane = 6;
  for (auto& deviation : forces.uncertainty) deviation = floats(plane++);
  forces.status = {status, pillars};
  shown_.raw = raw->view();
  shown_.pages = {pages.get(), bytes};
  shown_.keep_alive = std::make_shared<std::pair<decltype(pages), decltype(raw)>>(pages, raw);

  source_.name = "made up";
  source_.kind = "scene";
  source_.skin.rows = 2 * rows;
  source_.skin.cols = 2 * cols;
  source_.skin.sensel_pitch_mm = 0.5;
  source_.skin.counts_per_newton = 100;
  source_.frames = 1;
  source_.has_readings = true;
  source_.has_angles = true;
  source_.has_uncertainty = true;
}

MadeUpField MadeUpField::without_pillars() const {
  MadeUpField bare = *this;
  ForceFieldView& forces = bare.shown_.forces;
  for (auto* const plane :
       {&forces.shear_x, &forces.shear_y, &forces.magnitude, &forces.theta, &forces.phi}) {
    *plane = {};
  }
  const auto deviation = forces.uncertainty[Uncertainty::normal];
  forces.uncertainty = {};
  forces.uncertainty[Uncertainty::normal] = deviation;
  bare.shown_.raw = {};
  bare.source_.skin.layout = SkinLayout::sensels;
  bare.source_.skin.rows = forces.rows;
  bare.source_.skin.cols = forces.cols;
  const Pitch pillar_mm = source_.skin.element_pitch_mm();
  bare.source_.skin.sensel_pitch_mm = {1.3 * pillar_mm.row_mm, pillar_mm.col_mm};
  bare.source_.has_readings = bare.source_.has_angles = false;
  return bare;
}

}  // namespace pillarfield::viewer
