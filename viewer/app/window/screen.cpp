#include "viewer/app/window/screen.h"

#include <algorithm>
#include <cmath>

namespace pillarfield::viewer {
namespace {

constexpr double kColumn = 340;
constexpr double kTransport = 46;
constexpr double kStatus = 26;

}  // namespace

Screen divide(std::uint32_t width, std::uint32_t height, double scale, bool with_column) {
  const double wide = std::max(width, 1u);
  const double high = std::max(height, 1u);
  // In a narrow window the column takes less than half.
  const double column = with_column ? std::round(std::min(kColumn * scale, 0.45 * wide)) : 0;
  const double status = std::min(std::round(kStatus * scale), high - 1);
  const double transport = std::min(std::round(kTransport * scale), high - 1 - status);
  const double left = std::max(wide - column, 1.0);
  const double above = high - status;
  Screen screen;
  screen.field = {0, 0, left, above - transport};
  screen.column = {left, 0, wide - left, above};
  screen.transport = {0, above - transport, left, transport};
  screen.status = {0, above, wide, status};
  return screen;
}

bool contains(const Viewport& box, Vec2 pixel) {
  return pixel.x >= box.x && pixel.y >= box.y && pixel.x < box.x + box.width &&
         pixel.y < box.y + box.height;
}

}  // namespace pillarfield::viewer
