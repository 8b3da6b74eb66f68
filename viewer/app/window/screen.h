#pragma once

#include <cstdint>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

struct PanelLayout;

/// Parts of the window, in whole pixels. Columns and row without panels have width or height 0.
struct Screen {
  Viewport field;      ///< the picture
  Viewport left;       ///< a column of panels
  Viewport right;      ///< a column of panels
  Viewport bottom;     ///< a row of panels, below the play head
  Viewport transport;  ///< the play head, below the field
  Viewport status;     ///< one line at the bottom
};

/// Divides `width` x `height` pixels; the field has at least one pixel. `layout` is null while
/// panels are hidden.
[[nodiscard]] Screen divide(std::uint32_t width, std::uint32_t height, double scale,
                            const PanelLayout* layout);

[[nodiscard]] bool contains(const Viewport& box, Vec2 pixel);

}  // namespace pillarfield::viewer
