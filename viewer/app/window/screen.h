#pragma once

#include <cstdint>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// Parts of the window, in whole pixels.
struct Screen {
  Viewport field;      ///< the picture
  Viewport column;     ///< the panels, right; width 0 while hidden
  Viewport transport;  ///< the play head, below the field
  Viewport status;     ///< one line at the bottom
};

/// Divides `width` x `height` pixels; the field has at least one pixel.
[[nodiscard]] Screen divide(std::uint32_t width, std::uint32_t height, double scale,
                            bool with_column);

[[nodiscard]] bool contains(const Viewport& box, Vec2 pixel);

}  // namespace pillarfield::viewer
