#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pillarfield/skin.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

enum class PanelId : std::uint8_t {
  sensor,
  view,
  selection,
  boxes,
  contacts,
  cursor,
  pillar,
  write,
  curves
};
inline constexpr std::size_t kPanels = 9;
[[nodiscard]] const char* title_of(PanelId id, SkinLayout layout);

/// Where a panel is: in a column, in the row below the field, or a window of its own.
enum class Dock : std::uint8_t { left, right, bottom, floating };
inline constexpr std::size_t kDocks = 4;
[[nodiscard]] const char* title_of(Dock dock);

struct PanelPlace {
  PanelId id = PanelId::view;
  Dock dock = Dock::right;
  bool open = true;                     ///< not folded
  bool used = true;                     ///< has something to show; else it takes no place
  Viewport window{160, 120, 360, 300};  ///< while floating, nominal pixels
};

/// Places of all panels, in their order in each dock, and sizes in nominal pixels.
struct PanelLayout {
  std::vector<PanelPlace> places;
  double left_width = 300;
  double right_width = 284;
  double bottom_height = 0;             ///< 0: by the window
  double bottom_more = 0;               ///< added to that by the window, for names of curves
  std::optional<PanelId> dragged = {};  ///< its heading is being dragged
};

/// Curves below the field, the others at the right.
[[nodiscard]] PanelLayout default_layout();

[[nodiscard]] PanelPlace& place_of(PanelLayout& layout, PanelId id);

/// Moves a panel to the end of a dock.
void move_panel(PanelLayout& layout, PanelId id, Dock dock);

/// True for a dock with a panel in use.
[[nodiscard]] bool has_panels(const PanelLayout& layout, Dock dock);

/// True if a floating panel covers a pixel.
[[nodiscard]] bool covers(const PanelLayout& layout, Vec2 pixel, double scale);

/// One line for each panel and size; layout_from() takes the lines that it understands, within
/// limits, and the default for the rest.
[[nodiscard]] std::string text_of(const PanelLayout& layout);
[[nodiscard]] PanelLayout layout_from(std::string_view text);

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
