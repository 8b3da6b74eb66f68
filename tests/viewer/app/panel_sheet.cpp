// Draws all panels without a window, in both themes and at two scales, into files.
#include <gtest/gtest.h>
#include <imgui.h>

#include <set>

#include "tests/viewer/app/made_field.h"
#include "viewer/app/export/export.h"
#include "viewer/app/input/marks.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"
#include "viewer/render/gui_context.h"
#include "viewer/render/target.h"

namespace pillarfield::viewer {
namespace {

class OneField final : public FieldProducer {
 public:
  explicit OneField(const MadeField& made) : made_(made), info_(made.source()) {}
  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t /*index*/) override { return made_.shown(); }

 private:
  const MadeField& made_;
  SourceInfo info_;
};

/// The pillar of a region with the largest normal force.
PillarIndex a_pillar(const MadeField& made, Region region, float left_of = 40) {
  PillarIndex found;
  float most = -1;
  for (std::size_t at = 0; at < made.forces.elements(); ++at) {
    const auto col = static_cast<std::uint32_t>(at % made.forces.cols);
    if (region_of(made.forces.status[at]) != region || static_cast<float>(col) >= left_of) continue;
    if (made.magnitude[at] <= most) continue;
    most = made.magnitude[at];
    found = {static_cast<std::uint32_t>(at / made.forces.cols), col};
  }
  return found;
}

/// Curves of pins and selection that fade over four seconds.
void fill(Curves& curves, const AppState& state) {
  std::vector<PillarRect> rects{state.selection->rect};
  for (const Pin& pin : state.pins) rects.push_back(rect_of(pin));
  curves.set_rects(rects);
  ForceField forces(state.field->forces.rows, state.field->forces.cols);
  std::ranges::copy(state.field->forces.status, forces.status.begin());
  PillarValues last;
  last.normal = 1;
  last.shear_x = 0.6f;
  for (const CurvePoint& point : made_curve(last, 400)) {
    for (std::size_t at = 0; at < forces.elements(); ++at) {
      forces.normal[at] = point.normal * state.field->forces.normal[at];
      forces.shear_x[at] = point.shear_x * state.field->forces.normal[at];
      forces.shear_y[at] = point.shear_y * state.field->forces.normal[at];
    }
    ShownField field;
    field.forces = forces.view();
    field.index = point.index;
    field.time_s = point.time_s;
    curves.add(field);
  }
}

AppState make_state(const MadeField& made, Player& player, Curves& curves) {
  AppState state;
  state.player = &player;
  state.field = made.shown();
  state.settings.contacts = true;
  state.field->contacts =
      std::make_shared<const ShownContacts>(FieldContacts(1.265).contacts_of(*state.field));
  state.hovered = a_pillar(made, Region::two);
  for (const PillarIndex pillar :
       {a_pillar(made, Region::one), a_pillar(made, Region::two), a_pillar(made, Region::three)}) {
    state.pins.push_back({pillar});
  }
  state.selection = Selection{{4, 25, 8, 36}};
  state.curves = &curves;
  fill(curves, state);
  return state;
}

void set_style(Theme theme, double scale) {
  ImGui::GetStyle() = ImGuiStyle();
  if (theme == Theme::dark) {
    ImGui::StyleColorsDark();
  } else {
    ImGui::StyleColorsLight();
  }
  ImGuiStyle& imgui_style = ImGui::GetStyle();
  imgui_style.WindowPadding = ImVec2(14, 10);
  imgui_style.ItemSpacing = ImVec2(8, 6);
  imgui_style.Colors[ImGuiCol_WindowBg].w = 1;
  imgui_style.ScaleAllSizes(static_cast<float>(scale));
}

/// Draws a panel in its own ImGui window; position and size at scale 1.
template <class Panel>
void in_window(const char* name, const Viewport& box, double scale, Panel&& panel) {
  const auto sized = [scale](double x, double y) { return to_imgui({x * scale, y * scale}); };
  ImGui::SetNextWindowPos(sized(box.x, box.y));
  ImGui::SetNextWindowSize(sized(box.width, box.height));
  ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
  panel();
  ImGui::End();
}

constexpr double kWidth = 1550;
constexpr double kHeight = 1260;

/// The column of the application is 340 wide; some panels are drawn wider.
void draw_windows(AppState& state, double scale) {
  const FieldPlace place{{0, 0, 800, 600}, &state.player->info()};
  in_window("Cursor", {10, 10, 340, 220}, scale, [&] { hover_panel(state); });
  in_window("Selection", {10, 240, 340, 310}, scale, [&] { selection_panel(state); });
  in_window("Region 3", {360, 10, 340, 540}, scale, [&] { pillar_panel(state); });
  inspect_pin(state, 1);
  in_window("Region 2", {710, 10, 340, 540}, scale, [&] { pillar_panel(state); });
  inspect_pin(state, 0);
  in_window("Region 1, wide", {1060, 10, 480, 540}, scale, [&] { pillar_panel(state); });
  in_window("Time", {360, 560, 340, 430}, scale, [&] { time_panel(state); });
  in_window("Time, wide", {710, 560, 830, 320}, scale, [&] { time_panel(state); });
  AppState nothing;
  nothing.player = state.player;
  nothing.settings = state.settings;
  in_window("Nothing", {10, 560, 340, 160}, scale, [&] {
    hover_panel(nothing);
    pillar_panel(nothing);
    selection_panel(nothing);
    contacts_panel(nothing, place);
    time_panel(nothing);
  });
  in_window("Contacts", {10, 1000, 340, 250}, scale, [&] { contacts_panel(state, place); });
  in_window("Contacts, wide", {360, 1000, 830, 250}, scale, [&] { contacts_panel(state, place); });
  state.field->raw = {};
  in_window("No readings", {10, 730, 340, 260}, scale, [&] { pillar_panel(state); });
}

class PanelSheet : public testing::Test {
 protected:
  Pixels draw(Theme theme, double scale) {
    const vk::Extent2D size(static_cast<std::uint32_t>(kWidth * scale),
                            static_cast<std::uint32_t>(kHeight * scale));
    const vk::raii::RenderPass pass = Target::make_render_pass(device_);
    const Target target(device_, *pass, size);
    const GuiContext gui(instance_, device_, *pass, scale);
    gui.use();
    set_style(theme, scale);
    Curves curves(1.265);
    for (int frame = 0; frame < 2; ++frame) {  // ImGui lays windows out in the second frame.
      AppState state = make_state(made_, player_, curves);
      state.settings.theme = theme;
      state.settings.scale = scale;
      ImGui::GetIO().DisplaySize =
          ImVec2(static_cast<float>(size.width), static_cast<float>(size.height));
      ImGui::GetIO().DeltaTime = 0.1f;
      ImGui::NewFrame();
      draw_windows(state, scale);
      ImGui::Render();
    }
    const std::array<vk::ClearValue, 2> clear{
        vk::ClearColorValue(std::array{0.3f, 0.32f, 0.35f, 1.0f}),
        vk::ClearDepthStencilValue(1, 0)};
    device_.run([&](const vk::raii::CommandBuffer& commands) {
      commands.beginRenderPass(
          vk::RenderPassBeginInfo(*pass, target.framebuffer(), {{0, 0}, size}, clear),
          vk::SubpassContents::eInline);
      gui.draw(commands);
      commands.endRenderPass();
    });
    return read_pixels(device_, target.image());
  }

  gpu::Instance instance_{{}, true};
  gpu::Device device_{instance_, {}};
  MadeField made_;
  FilePlayer player_{std::make_unique<OneField>(made_)};
};

std::size_t colours_in(const Pixels& pixels) {
  std::set<std::array<std::uint8_t, 3>> colours;
  for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
    colours.insert({pixels.rgba[i], pixels.rgba[i + 1], pixels.rgba[i + 2]});
  }
  return colours.size();
}

TEST_F(PanelSheet, DrawsAllPanelsInBothThemesAndAtTwoScalesWithoutAValidationMessage) {
  for (const Theme theme : {Theme::dark, Theme::light}) {
    for (const double scale : {1.0, 2.0}) {
      const Pixels pixels = draw(theme, scale);
      EXPECT_GT(colours_in(pixels), 100u);
      const std::string name = std::string("panels_") + (theme == Theme::dark ? "dark" : "light") +
                               (scale > 1 ? "_2" : "_1") + ".png";
      write_png(name, pixels);
    }
  }
  EXPECT_EQ(instance_.validation_messages(), 0);
}

}  // namespace
}  // namespace pillarfield::viewer
