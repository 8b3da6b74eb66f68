#include "viewer/app/window/screen.h"

#include <algorithm>
#include <cmath>

#include "viewer/app/window/panel_layout.h"

namespace pillarfield::viewer {
namespace {

constexpr double kTransport = 46;
constexpr double kStatus = 26;
constexpr double kFoldedRow = 44;

bool has_open_panels(const PanelLayout& layout, Dock dock) {
  return std::ranges::any_of(
      layout.places, [&](const PanelPlace& place) { return place.dock == dock && place.open; });
}

/// Height of the row, nominal pixels.
double row_height(const PanelLayout& layout) {
  if (!has_panels(layout, Dock::bottom)) return 0;
  return has_open_panels(layout, Dock::bottom) ? layout.bottom_height : kFoldedRow;
}

}  // namespace

Screen divide(std::uint32_t width, std::uint32_t height, double scale, const PanelLayout* layout) {
  const double wide = std::max(width, 1u);
  const double high = std::max(height, 1u);
  // In a narrow window a column takes less than a third, in a low one the row too.
  const auto column = [&](Dock dock, double size) {
    if (layout == nullptr || !has_panels(*layout, dock)) return 0.0;
    return std::round(std::min(size * scale, 0.36 * wide));
  };
  const double left = layout == nullptr ? 0 : column(Dock::left, layout->left_width);
  const double right = layout == nullptr ? 0 : column(Dock::right, layout->right_width);
  const double status = std::min(std::round(kStatus * scale), high - 1);
  const double transport = std::min(std::round(kTransport * scale), high - 1 - status);
  const double above = high - status;
  const double row =
      layout == nullptr ? 0 : std::round(std::min(row_height(*layout) * scale, 0.4 * above));
  const double middle = std::max(wide - left - right, 1.0);
  const double field = std::max(above - transport - row, 1.0);
  Screen screen;
  screen.field = {left, 0, middle, field};
  screen.left = {0, 0, left, above};
  screen.right = {left + middle, 0, wide - left - middle, above};
  screen.transport = {left, field, middle, transport};
  screen.bottom = {left, field + transport, middle, above - field - transport};
  screen.status = {0, above, wide, status};
  return screen;
}

bool contains(const Viewport& box, Vec2 pixel) {
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x < box.x + box.width &&
         pixel.y < box.y + box.height;
}

}  // namespace pillarfield::viewer
