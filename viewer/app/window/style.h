#pragma once

#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Sets colours, spacing and edges of the current ImGui context.
void set_style(Theme theme, double scale);

/// Further colours, packed as in ImGui.
struct Palette {
  unsigned background;  ///< of the window
  unsigned panel;       ///< column and transport
  unsigned line;        ///< separators
  unsigned text;
  unsigned faint;
  unsigned accent;
};
[[nodiscard]] Palette palette_of(Theme theme);

}  // namespace pillarfield::viewer
