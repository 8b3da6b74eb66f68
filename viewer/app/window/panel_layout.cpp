#include "viewer/app/window/panel_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace pillarfield::viewer {
namespace {

constexpr std::array<const char*, kPanels> kPanelTitles{"Sensor", "View",     "Selection",
                                                        "Boxes",  "Contacts", "Under the cursor",
                                                        "Pillar", "Write",    "Over time"};
constexpr std::array<const char*, kPanels> kPanelNames{
    "sensor", "view", "selection", "boxes", "contacts", "cursor", "pillar", "write", "curves"};
constexpr std::array<const char*, kDocks> kDockTitles{"Left", "Right", "Bottom", "Window"};
constexpr std::array<const char*, kDocks> kDockNames{"left", "right", "bottom", "floating"};

constexpr double kLeastSize = 120;
constexpr double kMostSize = 2000;

template <std::size_t size>
std::optional<std::size_t> place_in(const std::array<const char*, size>& names,
                                    const std::string& name) {
  const auto found = std::ranges::find_if(names, [&](const char* each) { return name == each; });
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

/// A line "panel NAME DOCK OPEN X Y WIDTH HEIGHT".
std::optional<PanelPlace> panel_from(std::istream& line) {
  std::string name;
  std::string dock;
  PanelPlace place;
  Viewport& box = place.window;
  if (!(line >> name >> dock >> place.open >> box.x >> box.y >> box.width >> box.height)) return {};
  const auto id = place_in(kPanelNames, name);
  const auto where = place_in(kDockNames, dock);
  if (!id || !where) return {};
  place.id = static_cast<PanelId>(*id);
  place.dock = static_cast<Dock>(*where);
  box = {std::clamp(box.x, 0.0, kMostSize), std::clamp(box.y, 0.0, kMostSize),
         std::clamp(box.width, kLeastSize, kMostSize),
         std::clamp(box.height, kLeastSize, kMostSize)};
  return place;
}

void take_size(PanelLayout& layout, const std::string& name, double size) {
  const double width = std::clamp(size, kLeastSize, kMostSize);
  if (name == "left_width") layout.left_width = width;
  if (name == "right_width") layout.right_width = width;
  if (name == "bottom_height") layout.bottom_height = std::clamp(size, 0.0, kMostSize);
}

}  // namespace

const char* title_of(PanelId id, SkinLayout layout) {
  if (id == PanelId::pillar && layout == SkinLayout::sensels) return "Sensel";
  return kPanelTitles.at(static_cast<std::size_t>(id));
}
const char* title_of(Dock dock) { return kDockTitles.at(static_cast<std::size_t>(dock)); }

PanelLayout default_layout() {
  PanelLayout layout;
  for (std::size_t i = 0; i < kPanels; ++i) layout.places.push_back({static_cast<PanelId>(i)});
  place_of(layout, PanelId::curves).dock = Dock::bottom;
  return layout;
}

PanelPlace& place_of(PanelLayout& layout, PanelId id) {
  return *std::ranges::find(layout.places, id, &PanelPlace::id);
}

void move_panel(PanelLayout& layout, PanelId id, Dock dock) {
  const auto found = std::ranges::find(layout.places, id, &PanelPlace::id);
  found->dock = dock;
  std::rotate(found, found + 1, layout.places.end());
}

bool has_panels(const PanelLayout& layout, Dock dock) {
  return std::ranges::any_of(
      layout.places, [&](const PanelPlace& place) { return place.dock == dock && place.used; });
}

bool covers(const PanelLayout& layout, Vec2 pixel, double scale) {
  return std::ranges::any_of(layout.places, [&](const PanelPlace& place) {
    const Viewport& box = place.window;
    return place.dock == Dock::floating && place.used &&
           contains({box.x * scale, box.y * scale, box.width * scale, box.height * scale}, pixel);
  });
}

std::string text_of(const PanelLayout& layout) {
  std::string text;
  for (const PanelPlace& place : layout.places) {
    const Viewport& box = place.window;
    text += fmt::format("panel {} {} {:d} {:.0f} {:.0f} {:.0f} {:.0f}\n",
                        kPanelNames.at(static_cast<std::size_t>(place.id)),
                        kDockNames.at(static_cast<std::size_t>(place.dock)), place.open, box.x,
                        box.y, box.width, box.height);
  }
  return text + fmt::format("left_width {:.0f}\nright_width {:.0f}\nbottom_height {:.0f}\n",
                            layout.left_width, layout.right_width, layout.bottom_height);
}

PanelLayout layout_from(std::string_view text) {
  PanelLayout layout = default_layout();
  std::istringstream lines{std::string(text)};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    words >> name;
    double size = 0;
    if (name == "panel") {
      const auto place = panel_from(words);
      if (!place) continue;
      move_panel(layout, place->id, place->dock);
      layout.places.back() = *place;
    } else if (words >> size) {
      take_size(layout, name, size);
    }
  }
  return layout;
}

namespace {

constexpr double kTransport = 36;
constexpr double kStatus = 24;
constexpr double kFoldedRow = 28;
constexpr double kShareOfRow = 0.12;  ///< of the window's height, until the user drags its edge

bool has_open_panels(const PanelLayout& layout, Dock dock) {
  return std::ranges::any_of(layout.places, [&](const PanelPlace& place) {
    return place.dock == dock && place.used && place.open;
  });
}

/// Height of the row, pixels.
double row_height(const PanelLayout& layout, double above, double scale) {
  if (!has_panels(layout, Dock::bottom)) return 0;
  if (!has_open_panels(layout, Dock::bottom)) return kFoldedRow * scale;
  if (layout.bottom_height > 0) return layout.bottom_height * scale;
  return kShareOfRow * above + layout.bottom_more * scale;
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
      layout == nullptr ? 0 : std::round(std::min(row_height(*layout, above, scale), 0.4 * above));
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
