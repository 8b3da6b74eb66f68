#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

#include "viewer/app/input/actions.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {
namespace {

std::string words_of(Quantity quantity, const Units& units) {
  return units.title(info_of(quantity).title, info_of(quantity).dimension);
}

void choose_quantity(AppState& state) {
  const Units& units = state.look.settings.units;
  labelled("Quantity");
  if (!ImGui::BeginCombo("##quantity", words_of(state.look.settings.quantity, units).c_str(),
                         ImGuiComboFlags_HeightLargest)) {
    return;
  }
  for (int i = 0; i < kQuantities; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    if (!is_available(quantity, state.source.player->info())) continue;
    if (ImGui::Selectable(words_of(quantity, units).c_str(),
                          quantity == state.look.settings.quantity)) {
      show_quantity(state, quantity);
    }
  }
  ImGui::EndCombo();
}

bool is_fixed(Quantity quantity) {
  const Scale scale = info_of(quantity).scale;
  return scale == Scale::classes || scale == Scale::cyclic;
}

/// Low and high end in the displayed unit, side by side.
void edit_range(AppState& state) {
  RenderSettings& settings = state.look.settings;
  const auto factor =
      static_cast<float>(settings.units.of(info_of(settings.quantity).dimension).factor);
  std::array<float, 2> ends{settings.range.low * factor, settings.range.high * factor};
  const float width = ends[1] - ends[0];
  labelled("Range");
  if (ImGui::DragFloat2("##range", ends.data(), 0.005f * width, 0, 0, "%.4g")) {
    // In a symmetric range the other end follows.
    const bool low_moved = ends[0] != settings.range.low * factor;
    const bool symmetric = info_of(settings.quantity).scale == Scale::diverging;
    const float high = symmetric && low_moved ? -ends[0] : ends[1];
    state.look.fit_each_field = false;
    set_range(state, {ends[0] / factor, high / factor});
  }
}

void choose_range(AppState& state) {
  if (is_fixed(state.look.settings.quantity)) return;
  edit_range(state);
  labelled("");
  const float half = 0.5f * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (ImGui::Button("Fit", ImVec2(half, 0))) fit_range(state);
  ImGui::SameLine();
  ImGui::Checkbox("each frame", &state.look.fit_each_field);
}

/// A colour map as a strip over the last item.
void draw_map(ColourMap map, float left, float right, float top, float bottom) {
  const auto table = table_of(map);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  constexpr std::size_t kStrips = 64;
  for (std::size_t i = 0; i < kStrips; ++i) {
    const auto edge = [&](std::size_t strip) {
      return left + (right - left) * static_cast<float>(strip) / static_cast<float>(kStrips);
    };
    const Colour& colour = table[i * kColours / kStrips];
    list.AddRectFilled(ImVec2(edge(i), top), ImVec2(edge(i + 1), bottom),
                       IM_COL32(colour.red, colour.green, colour.blue, 255));
  }
}

void draw_map_in_item(ColourMap map, float margin_right) {
  const ImVec2 low = ImGui::GetItemRectMin();
  const ImVec2 high = ImGui::GetItemRectMax();
  const float middle = low.x + 0.45f * (high.x - low.x);
  const float inset = 0.28f * (high.y - low.y);
  draw_map(map, middle, high.x - margin_right, low.y + inset, high.y - inset);
}

bool suits(ColourMap map, Scale scale) {
  if (scale == Scale::sequential) return map == ColourMap::cividis || map == ColourMap::viridis;
  return map == default_map(scale);
}

void choose_map(RenderSettings& settings) {
  const Scale scale = info_of(settings.quantity).scale;
  if (scale == Scale::classes) return;
  labelled("Colours");
  const bool open = ImGui::BeginCombo("##map", name_of(settings.map));
  if (!open) {
    draw_map_in_item(settings.map, ImGui::GetFrameHeight() + ImGui::GetStyle().FramePadding.x);
    return;
  }
  for (int i = 0; i < kColourMaps; ++i) {
    const auto map = static_cast<ColourMap>(i);
    if (!suits(map, scale)) continue;
    if (ImGui::Selectable(name_of(map), map == settings.map)) settings.map = map;
    draw_map_in_item(map, ImGui::GetStyle().FramePadding.x);
  }
  ImGui::EndCombo();
}

/// Check boxes, two in a row.
class LayerBoxes {
 public:
  /// True if clicked.
  bool add(const char* words, bool& shown, const char* help) {
    if (count_ % 2 == 0) labelled(count_ == 0 ? "Layers" : "");
    if (count_ % 2 == 1) ImGui::SameLine(0.62f * ImGui::GetWindowWidth());
    ++count_;
    const bool clicked = ImGui::Checkbox(words, &shown);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
    return clicked;
  }

 private:
  int count_ = 0;
};

void choose_layers(const Command& command) {
  AppState& state = command.state;
  RenderSettings& settings = state.look.settings;
  const bool pillars = state.source.player->info().skin.has_pillars();
  LayerBoxes boxes;
  if (pillars) boxes.add("arrows", settings.arrows, "the forces (A)");
  bool contacts = settings.contacts;
  if (boxes.add("contacts", contacts, "extent, force, centre of pressure (K)")) {
    show_contacts(state, contacts);
  }
  boxes.add("relief", settings.relief, "in 3-D, the normal force raises the skin (B)");
  if (pillars) {
    boxes.add("hatch", settings.hatch, "ambiguous pillars (X)");
    boxes.add("sectors", settings.sectors, "uncertainty of ambiguous shear, at large zoom (U)");
  }
  bool truth = state.source.beside_is_truth;
  if ((state.source.open_truth || truth) &&
      boxes.add("truth", truth, "the true forces beside (W)")) {
    command.pending.truth = true;
  }
  bool light = settings.theme == Theme::light;
  if (boxes.add("light", light, "dark on white (T)")) {
    settings.theme = light ? Theme::light : Theme::dark;
  }
}

void choose_view(const Command& command) {
  constexpr std::array<const char*, 2> kViews{"Top", "3-D"};
  labelled("View");
  int chosen = shows_orbit(command.state.look.settings) ? 1 : 0;
  if (toggle_group("view", kViews, chosen)) show_orbit(command.state, command.place, chosen == 1);
}

void choose_surface(const Command& command) {
  constexpr std::array<const char*, 3> kSurfaces{"Plane", "Cylinder", "Sphere"};
  Surface surface = command.state.look.settings.surface;
  int chosen = static_cast<int>(surface.shape);
  labelled("Surface");
  const double width = command.place.skin().width_mm;
  if (toggle_group("surface", kSurfaces, chosen)) {
    surface.shape = static_cast<SurfaceShape>(chosen);
    if (surface.radius_mm == 0) surface.radius_mm = 0.5 * width;
    set_surface(command.state, command.place, surface);
  }
  if (surface.shape == SurfaceShape::plane) return;
  labelled("Radius");
  const auto [unit, factor] = command.state.look.settings.units.of(Dimension::length);
  auto radius = static_cast<float>(surface.radius_mm * factor);
  // The smallest radius lets the sheet close around the cylinder.
  const auto least = static_cast<float>(0.17 * width * factor);
  const auto most = static_cast<float>(20 * width * factor);
  if (ImGui::DragFloat("##radius", &radius, 0.01f * radius, least, most,
                       with_unit("%.1f", unit).c_str(), ImGuiSliderFlags_AlwaysClamp)) {
    surface.radius_mm = static_cast<double>(radius) / factor;
    set_surface(command.state, command.place, surface);
  }
}

}  // namespace

void view_panel(const Command& command) {
  AppState& state = command.state;
  choose_quantity(state);
  choose_range(state);
  choose_map(state.look.settings);
  choose_layers(command);
  choose_view(command);
  if (shows_orbit(state.look.settings)) choose_surface(command);
}

void write_panel(const Command& command) {
  const ImGuiStyle& imgui_style = ImGui::GetStyle();
  const float width = (ImGui::GetContentRegionAvail().x - 3 * imgui_style.ItemSpacing.x) / 4;
  const auto button = [&](const char* words, const char* help, bool& request) {
    if (ImGui::Button(words, ImVec2(width, 0))) request = true;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", help);
  };
  if (command.state.window.writing) {
    if (ImGui::Button("Stop writing", ImVec2(-1, 0))) command.pending.stop = true;
    return;
  }
  PendingActions& pending = command.pending;
  button("Picture", "Write this picture as PNG (P)", pending.picture);
  ImGui::SameLine();
  button("Frames", "Write a PNG of every frame (Ctrl+P)", pending.sequence);
  ImGui::SameLine();
  button("Video", "Write a video of all frames, by ffmpeg (Ctrl+M)", pending.video);
  ImGui::SameLine();
  button("Table", "Write the visible forces as CSV (C)", pending.table);
}

}  // namespace pillarfield::viewer
