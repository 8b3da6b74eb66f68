#include <imgui.h>

#include <array>

#include "viewer/app/input/actions.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/widgets.h"

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
  bool orbit = shows_orbit(settings);
  if (boxes.add("3-D", orbit, "from the top else (V)")) show_orbit(state, command.place, orbit);
  boxes.add("relief", settings.relief, "in 3-D, the normal force raises the skin (B)");
  if (pillars) {
    boxes.add("hatch", settings.hatch, "ambiguous pillars (X)");
    boxes.add("sectors", settings.sectors, "uncertainty of ambiguous shear, at large zoom (U)");
  }
  bool light = settings.theme == Theme::light;
  if (boxes.add("light", light, "dark on white (T)")) {
    settings.theme = light ? Theme::light : Theme::dark;
  }
}

}  // namespace

void view_panel(const Command& command) {
  AppState& state = command.state;
  choose_quantity(state);
  choose_range(state);
  choose_layers(command);
}

void write_panel(const Command& command) {
  const ImGuiStyle& imgui_style = ImGui::GetStyle();
  const float width = (ImGui::GetContentRegionAvail().x - 2 * imgui_style.ItemSpacing.x) / 3;
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
  button("Video", "Write a video of all frames, by ffmpeg (Ctrl+M)", pending.video);
  ImGui::SameLine();
  button("Table", "Write the visible forces as CSV (C)", pending.table);
}

}  // namespace pillarfield::viewer
