#pragma once

#include <imgui.h>

#include <string>

#include "viewer/style/colour_map.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// Colours and sizes of what a panel draws itself, from the current style of Dear ImGui.
struct PanelStyle {
  ImU32 text;    ///< words, numbers, and lines that matter
  ImU32 faint;   ///< labels, axes
  ImU32 grid;    ///< barely there
  ImU32 raised;  ///< the ground of plots and bars
  ImU32 ground;  ///< of the panel
  double unit;   ///< pixels that a pixel of a plain display is here
  double line;   ///< height of a line of text, pixels
};
[[nodiscard]] PanelStyle panel_style(double scale);

[[nodiscard]] ImU32 packed(const Colour& colour);

/// `share` of `over` on `under`, opaque.
[[nodiscard]] ImU32 mixed(ImU32 under, ImU32 over, double share);
[[nodiscard]] ImU32 with_alpha(ImU32 colour, double alpha);

[[nodiscard]] inline ImVec2 point(Vec2 place) {
  return {static_cast<float>(place.x), static_cast<float>(place.y)};
}
[[nodiscard]] double width_of(const std::string& text);

/// Where a text stands about its place.
enum class Align { left, middle, right };

/// On whole pixels; `y` is its upper edge.
void draw_text(ImDrawList& list, Vec2 place, ImU32 colour, const std::string& text,
               Align align = Align::left);

/// Filled, on whole pixels, one at least in each direction.
void draw_block(ImDrawList& list, const Viewport& box, ImU32 colour);

/// Takes `width` x `height` pixels of the current window, as wide as it is where `width` is 0.
[[nodiscard]] Viewport take_room(double width, double height);

/// An empty space in the height of the panel.
void leave_gap(const PanelStyle& style, double pixels);

/// Words that tell that there is nothing to show.
void faint_words(const PanelStyle& style, const char* words);

/// The title of a panel's part, with further words in faint ink.
void heading(const PanelStyle& style, const std::string& words, const std::string& further = {});

}  // namespace pillarfield::viewer
