#include "tests/viewer/render/drawing.h"

#include <gtest/gtest.h>

#include "pillarfield/error.h"

namespace pillarfield::viewer {
namespace {

gpu::Instance watched_instance() {
  try {
    return {{}, true};
  } catch (const Error&) {
    return {{}, false};
  }
}

gpu::Device preferred_device(const gpu::Instance& instance, bool import_memory) {
  try {
    return {instance, {"llvmpipe", {}, import_memory}};
  } catch (const Error&) {
    return {instance, {"", {}, import_memory}};
  }
}

}  // namespace

Drawing::Drawing(bool import_memory)
    : instance_(watched_instance()),
      device_(preferred_device(instance_, import_memory)),
      renderer_(instance_, device_, {64, 64}, 1) {}

Pixels Drawing::draw(const ShownField& field, const SourceInfo& source,
                     const RenderSettings& settings, std::uint32_t width, std::uint32_t height) {
  renderer_.resize({width, height}, settings.scale);
  device_.run([&](const vk::raii::CommandBuffer& commands) {
    renderer_.record(commands, field, source, settings);
  });
  return read_pixels(device_, renderer_.image());
}

Colour colour_at(const Pixels& pixels, std::uint32_t x, std::uint32_t y) {
  const std::size_t place = std::size_t{4} * (std::size_t{y} * pixels.width + x);
  return {pixels.rgba.at(place), pixels.rgba.at(place + 1), pixels.rgba.at(place + 2)};
}

RenderSettings bare_settings(const MadeUpField& field, std::uint32_t width, std::uint32_t height) {
  RenderSettings settings;
  settings.arrows = false;
  settings.hatch = false;
  settings.legend = false;
  settings.view = fit_top(skin_size(field.source()),
                          {0, 0, static_cast<double>(width), static_cast<double>(height)});
  return settings;
}

PixelPlace middle_of(const MadeUpField& field, const RenderSettings& settings, std::uint32_t width,
                     std::uint32_t height, std::uint32_t row, std::uint32_t col) {
  const Skin& skin = field.source().skin;
  const auto [row_mm, col_mm] = skin.element_pitch_mm();
  const Viewport plot{0, 0, static_cast<double>(width), static_cast<double>(height)};
  const Vec3 place{(col + 0.5 - 0.5 * skin.element_cols()) * col_mm,
                   (0.5 * skin.element_rows() - row - 0.5) * row_mm, 0};
  const auto pixel = project(settings.view, {}, skin_size(field.source()), plot, place);
  EXPECT_TRUE(pixel.has_value());
  return {static_cast<std::uint32_t>(pixel->x), static_cast<std::uint32_t>(pixel->y)};
}

}  // namespace pillarfield::viewer
