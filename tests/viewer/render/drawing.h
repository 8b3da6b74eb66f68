#pragma once

#include "tests/viewer/render/made_up_field.h"
#include "viewer/render/renderer.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {

/// A graphics device for tests: the one that is a program, where there is one, so that pictures are
/// the same on every computer; watched by the validation layer where that is installed.
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

/// The whole skin from above, without arrows and writing.
[[nodiscard]] RenderSettings bare_look(const MadeUpField& field, std::uint32_t width,
                                       std::uint32_t height);

/// The pixel in the middle of a pillar, seen from above.
struct PixelPlace {
  std::uint32_t x, y;
};
[[nodiscard]] PixelPlace middle_of(const MadeUpField& field, const RenderSettings& settings,
                                   std::uint32_t width, std::uint32_t height, std::uint32_t row,
                                   std::uint32_t col);

}  // namespace pillarfield::viewer
