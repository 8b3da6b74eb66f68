#pragma once

#include "tests/viewer/render/made_up_field.h"
#include "viewer/render/renderer.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {

/// A graphics device for tests, with the validation layer where installed. Prefers a software
/// device, whose pictures do not depend on the computer.
class Drawing {
 public:
  explicit Drawing(bool import_memory = true);

  [[nodiscard]] Pixels draw(const ShownField& field, const SourceInfo& source,
                            const RenderSettings& settings, std::uint32_t width,
                            std::uint32_t height);
  [[nodiscard]] Pixels draw(const MadeUpField& field, const RenderSettings& settings,
                            std::uint32_t width, std::uint32_t height) {
    return draw(field.shown(), field.source(), settings, width, height);
  }

  [[nodiscard]] const gpu::Device& device() const { return device_; }
  [[nodiscard]] FieldMemory& memory() { return renderer_.memory(); }
  [[nodiscard]] int validation_messages() const { return instance_.validation_messages(); }

 private:
  gpu::Instance instance_;
  gpu::Device device_;
  Renderer renderer_;
};

/// Colour of a pixel, without alpha.
[[nodiscard]] Colour colour_at(const Pixels& pixels, std::uint32_t x, std::uint32_t y);

/// Top view of the whole skin without arrows and overlay.
[[nodiscard]] RenderSettings bare_settings(const MadeUpField& field, std::uint32_t width,
                                           std::uint32_t height);

/// Pixel at the centre of a pillar in a top view.
struct PixelPlace {
  std::uint32_t x, y;
};
[[nodiscard]] PixelPlace middle_of(const MadeUpField& field, const RenderSettings& settings,
                                   std::uint32_t width, std::uint32_t height, std::uint32_t row,
                                   std::uint32_t col);

}  // namespace pillarfield::viewer
