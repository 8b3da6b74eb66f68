#pragma once

#include <cstdint>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// How the window is divided, in whole pixels.
struct Screen {
  Viewport field;      ///< the picture
  Viewport column;     ///< the panels, right; no width where they are hidden
  Viewport transport;  ///< the play head, below the field
  Viewport status;     ///< one line at the bottom
};

/// Divides `width` x `height` pixels. The field keeps one pixel at least, however small the window.
[[nodiscard]] Screen divide(std::uint32_t width, std::uint32_t height, double scale,
                            bool with_column);

[[nodiscard]] bool contains(const Viewport& box, Vec2 pixel);

}  // namespace pillarfield::viewer
