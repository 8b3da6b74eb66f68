#pragma once

#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Gives the current context of ImGui the window's colours, spacing and edges.
void set_style(Theme theme, double scale);

/// Colours that ImGui has no name for, as it packs them.
struct Palette {
  unsigned background;  ///< behind everything
  unsigned panel;       ///< column and transport
  unsigned line;        ///< between parts
  unsigned text;
  unsigned faint;
  unsigned accent;
};
[[nodiscard]] Palette palette_of(Theme theme);

}  // namespace pillarfield::viewer
