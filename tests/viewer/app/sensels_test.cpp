// Nothing of pillars is shown of a skin of bare sensels: quantities, keys, panels, tables.
#include <gtest/gtest.h>
#include <imgui_internal.h>

#include <fstream>
#include <set>
#include <sstream>

#include "tests/io/sample_files.h"
#include "tests/viewer/app/fake_app_state.h"
#include "viewer/app/export/export.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/window/gui.h"

namespace pillarfield::viewer {
namespace {

std::set<std::string> available(const SourceInfo& source) {
  std::set<std::string> names;
  for (int i = 0; i < kQuantities; ++i) {
    const auto quantity = static_cast<Quantity>(i);
    if (is_available(quantity, source)) names.insert(info_of(quantity).name);
  }
  return names;
}

TEST(QuantitiesOfSensels, AreThoseOfNormalForce) {
  SourceInfo source = FakeProducer(SkinLayout::sensels).info();
  EXPECT_EQ(available(source),
            (std::set<std::string>{"normal", "peak", "pressure", "status", "uncertainty"}));
  source.has_uncertainty = false;
  EXPECT_EQ(available(source), (std::set<std::string>{"normal", "peak", "pressure", "status"}));
  EXPECT_EQ(available(FakeProducer().info()).size(), static_cast<std::size_t>(kQuantities));
}

TEST(KeysOfSensels, ThoseOfPillarsOnlySaySo) {
  std::size_t left_out = 0;
  for (const Shortcut& shortcut : shortcuts()) {
    FakeAppState fake(SkinLayout::sensels);
    const RenderSettings before = fake.state.settings;
    if (applies(shortcut, *fake.place.source)) continue;
    ++left_out;
    EXPECT_TRUE(dispatch(shortcut.chords[0], fake.command()));
    EXPECT_TRUE(fake.state.settings == before) << shortcut.keys;
    EXPECT_EQ(fake.state.notice.find("this source has no "), 0U) << shortcut.keys;
  }
  EXPECT_EQ(left_out, 8U + 3U);  // quantities and layers
  for (const Shortcut& shortcut : shortcuts()) {
    EXPECT_TRUE(applies(shortcut, FakeProducer().info())) << shortcut.keys;
  }
}

/// All words of the panels and of the help.
std::string words_of_panels(FakeAppState& fake) {
  ImGuiContext* const context = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = ImVec2(1600, 1600);
  unsigned char* pixels = nullptr;
  io.Fonts->GetTexDataAsAlpha8(&pixels, nullptr, nullptr);
  std::string words;
  for (int frame = 0; frame < 2; ++frame) {  // Sizes are known in the second.
    io.DeltaTime = 0.02f;
    ImGui::NewFrame();
    ImGui::SetNextWindowSize(ImVec2(500, 1600));
    ImGui::Begin("panels", nullptr, ImGuiWindowFlags_NoTitleBar);
    ImGui::LogToBuffer();
    draw_panels(fake.command());
    status_row(fake.state, "gpu");
    words = context->LogBuffer.c_str();
    ImGui::LogFinish();
    ImGui::End();
    ImGui::Render();
  }
  ImGui::DestroyContext(context);
  for (const Shortcut& shortcut : shortcuts()) {  // as in the help
    if (applies(shortcut, *fake.place.source)) words += std::string("\n") + shortcut.description;
  }
  for (const MouseHelp& help : mouse_help()) words += std::string("\n") + help.description;
  return words;
}

/// A state with something in every panel.
void fill_panels(FakeAppState& fake) {
  ShownField& field = *fake.state.field;
  fake.state.settings.contacts = true;
  const SourceInfo& source = *fake.place.source;
  field.contacts = std::make_shared<const ShownContacts>(
      FieldContacts(source.skin.element_pitch_mm(), source.contacts).contacts_of(field));
  toggle_pin(fake.state, {3, 4});
  select_pillars(fake.state, {1, 8, 2, 9});
  fake.state.hovered = PillarIndex{5, 6};
  fake.state.boxes = {{"heel", {1, 8, 2, 9}, 1}};
}

TEST(PanelsOfSensels, HaveNoWordOfPillars) {
  const std::vector<std::string> of_pillars{"illar",  "hear",   "egion", "gnitude", "ambig",
                                            "arity",  "slip",   "µ",     "φ",       "θ",
                                            "moment", "arrows", "hatch", "sectors"};
  FakeAppState sensels(SkinLayout::sensels);
  fill_panels(sensels);
  const std::string words = words_of_panels(sensels);
  for (const std::string& word : of_pillars) {
    EXPECT_EQ(words.find(word), std::string::npos) << word << " in " << words;
  }
  for (const std::string word : {"row 5, column 6", "pressure", "kPa", "20 × 30 sensels"}) {
    EXPECT_NE(words.find(word), std::string::npos) << word << " in " << words;
  }
  FakeAppState pillars;
  fill_panels(pillars);
  const std::string others = words_of_panels(pillars);
  for (const std::string& word : of_pillars) {
    EXPECT_NE(others.find(word), std::string::npos) << word;
  }
}

TEST(TableOfSensels, HasNormalForceAlone) {
  const io_test::TemporaryDirectory directory;
  const FakeAppState fake(SkinLayout::sensels);
  write_csv(directory / "t.csv", *fake.state.field, {0, 2, 1, 4}, Replace::nothing);
  std::ifstream file(directory / "t.csv");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "frame,time_s,row,col,normal_n,status");
  std::size_t rows = 0;
  while (std::getline(file, line)) ++rows;
  EXPECT_EQ(rows, 6U);
}

}  // namespace
}  // namespace pillarfield::viewer
