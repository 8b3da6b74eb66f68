#pragma once

#include <imgui.h>

#include <string>
#include <string_view>

#include "pillarfield/status.h"
#include "viewer/app/app_state.h"
#include "viewer/render/imgui_point.h"
#include "viewer/style/colour_map.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

/// Colours and sizes for custom drawing in panels, from the current ImGui style.
struct PanelStyle {
  ImU32 text;    ///< text and main lines
  ImU32 faint;   ///< labels, axes
  ImU32 grid;    ///< grid lines
  ImU32 raised;  ///< background of plots and bars
  ImU32 ground;  ///< background of the panel
  double unit;   ///< pixels per nominal pixel
  double line;   ///< height of a line of text, pixels
};
[[nodiscard]] PanelStyle panel_style(double scale);

inline constexpr Colour kWarningColour = colour_from(0xe69f00);

[[nodiscard]] ImU32 packed(const Colour& colour);

/// Opaque blend of `over` on `under`, `share` of it `over`.
[[nodiscard]] ImU32 mixed(ImU32 under, ImU32 over, double share);
[[nodiscard]] ImU32 with_alpha(ImU32 colour, double alpha);

[[nodiscard]] double width_of(const std::string& text);

/// Writes words at the right end of the room that is left.
void flush_right(const std::string& words);

/// The head of the next column of a table, flush right: words above their unit. `help` appears
/// under the mouse.
void column_head(const std::string& words, std::string_view unit, const std::string& help,
                 bool left = false);

/// Width of a column of numbers of at most seven digits below this head.
[[nodiscard]] float number_width(const std::string& head);

/// Alignment of a text to its position.
enum class Align { left, middle, right };

/// Draws text on whole pixels; `y` is the upper edge.
void draw_text(ImDrawList& list, Vec2 place, ImU32 colour, const std::string& text,
               Align align = Align::left);

/// Fills a box of whole pixels, at least one in each direction.
void draw_block(ImDrawList& list, const Viewport& box, ImU32 colour);

/// Reserves `width` x `height` pixels in the current window; width 0: all that is available.
[[nodiscard]] Viewport reserve(double width, double height);

/// Adds vertical space.
void leave_gap(const PanelStyle& style, double pixels);

/// A faint line of text in place of missing contents.
void faint_text(const PanelStyle& style, const char* words);

/// The title of a part of a panel, with `further` in the faint colour.
void heading(const PanelStyle& style, const std::string& words, const std::string& further = {});

/// The status of a pillar or sensel after a swatch in the colour of its region or fault; "no
/// sensel" where there is none.
void status_line(const PanelStyle& style, const AppState& state, PillarIndex pillar,
                 std::uint8_t status);

/// A swatch of a digit's height; the next item follows on the same line.
void swatch(const PanelStyle& style, ImU32 colour);

}  // namespace pillarfield::viewer
