#pragma once

#include <imgui.h>

#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// Converts pixels to Dear ImGui's type.
inline ImVec2 to_imgui(const Vec2& point) {
  return {static_cast<float>(point.x), static_cast<float>(point.y)};
}

}  // namespace pillarfield::viewer
