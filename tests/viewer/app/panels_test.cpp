// Panels: what their widgets do, and what they say of pillars and of sensels.
#include "viewer/app/panels/panels.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/io/sample_files.h"
#include "tests/viewer/app/fake_app_state.h"
#include "viewer/app/export/export.h"
#include "viewer/app/window/gui.h"

namespace pillarfield::viewer {
namespace {

struct Panels : testing::Test {
  void press(std::initializer_list<FakeGui::Name> path) {
    gui.press(path, [this] { draw_panels(fake.command()); });
  }
  [[nodiscard]] std::vector<int> pins() const {
    std::vector<int> numbers;
    for (const Pin& pin : fake.state.marks.pins) numbers.push_back(pin.number);
    return numbers;
  }

  FakeAppState fake;
  FakeGui gui;
};

TEST_F(Panels, EachWidgetActs) {
  RenderSettings& settings = fake.state.look.settings;
  set_range(fake.state, {0, 100});
  press({"View", "Fit"});
  EXPECT_EQ(settings.range, (Range{0, 3}));
  for (const auto& [name, layer] :
       {std::pair{"arrows", &RenderSettings::arrows},
        std::pair{"contacts", &RenderSettings::contacts},
        std::pair{"relief", &RenderSettings::relief}, std::pair{"hatch", &RenderSettings::hatch},
        std::pair{"sectors", &RenderSettings::sectors}}) {
    const bool before = settings.*layer;
    press({"View", name});
    EXPECT_NE(settings.*layer, before) << name;
  }
  press({"View", "light"});
  EXPECT_EQ(settings.theme, Theme::light);
  press({"View", "3-D"});
  EXPECT_TRUE(shows_orbit(settings));
  for (const auto& [name, request] :
       {std::pair{"Picture", &PendingActions::picture}, std::pair{"Video", &PendingActions::video},
        std::pair{"Table", &PendingActions::table}}) {
    press({"Write", name});
    EXPECT_TRUE(fake.pending.*request) << name;
  }
}

TEST_F(Panels, AHeadingFoldsItsPanel) {
  press({"View", "View"});
  press({"View", "relief"});
  EXPECT_FALSE(fake.state.look.settings.relief);
}

TEST_F(Panels, PinsAreChosenByTheirNumbersAndRemoved) {
  for (std::uint32_t i = 0; i < 3; ++i) fake.state.marks.pins.push_back({{10 + i, 20}});
  press({"Pillar", "pin 1"});
  EXPECT_EQ(pins(), (std::vector<int>{2, 3, 1}));
  press({"Pillar", "pin 3"});
  EXPECT_EQ(pins(), (std::vector<int>{2, 1, 3}));
  for (const std::size_t left : {2U, 1U, 0U}) {
    press({"Pillar", "remove"});
    EXPECT_EQ(fake.state.marks.pins.size(), left);
  }
  fake.state.marks.pins.push_back({{1000, 1000}});
  gui.frame([&] { draw_panels(fake.command()); });
  fake.state.source.field.reset();
  gui.frame([&] { draw_panels(fake.command()); });
  EXPECT_EQ(fake.state.marks.pins.size(), 1U) << "a pin outside the field";
}

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
            (std::set<std::string>{"normal", "pressure", "status", "uncertainty"}));
  source.has_uncertainty = false;
  EXPECT_EQ(available(source), (std::set<std::string>{"normal", "pressure", "status"}));
  EXPECT_EQ(available(FakeProducer().info()).size(), static_cast<std::size_t>(kQuantities));
}

TEST(KeysOfSensels, ThoseOfPillarsOnlySaySo) {
  std::size_t left_out = 0;
  for (const Shortcut& shortcut : shortcuts()) {
    EXPECT_TRUE(applies(shortcut, FakeProducer().info())) << shortcut.keys;
    FakeAppState fake(SkinLayout::sensels);
    const RenderSettings before = fake.state.look.settings;
    if (applies(shortcut, *fake.place.source)) continue;
    ++left_out;
    EXPECT_TRUE(dispatch(shortcut.chords[0], fake.command()));
    EXPECT_TRUE(fake.state.look.settings == before) << shortcut.keys;
    EXPECT_EQ(fake.state.window.notice.find("this source has no "), 0U) << shortcut.keys;
    EXPECT_TRUE(fake.state.window.notice.is_failure) << shortcut.keys;
  }
  EXPECT_EQ(left_out, 8U + 3U);  // quantities and layers
}

/// All words of the panels, each with something to show, and of the help.
std::string words_of_panels(SkinLayout layout) {
  FakeAppState fake(layout);
  const SourceInfo& source = *fake.place.source;
  fake.state.look.settings.contacts = true;
  fake.state.source.field->contacts = std::make_shared<const ShownContacts>(
      FieldContacts(source.skin.element_pitch_mm(), source.contacts)
          .contacts_of(*fake.state.source.field));
  toggle_pin(fake.state, {3, 4});
  fake.state.marks.hovered = PillarIndex{5, 6};
  FakeGui gui;
  std::string words;
  for (int i = 0; i < 2; ++i) {  // Sizes are known in the second frame.
    words = gui.frame([&] {
      draw_panels(fake.command());
      status_row(fake.state, "gpu");
    });
  }
  for (const Shortcut& shortcut : shortcuts()) {
    if (applies(shortcut, source)) words += std::string("\n") + shortcut.description;
  }
  for (const MouseHelp& help : mouse_help()) words += std::string("\n") + help.description;
  return words;
}

TEST(PanelsOfSensels, HaveNoWordOfPillars) {
  const std::string words = words_of_panels(SkinLayout::sensels);
  const std::string others = words_of_panels(SkinLayout::pillars);
  for (const std::string word : {"illar", "hear", "egion", "gnitude", "ambig", "arity", "slip", "φ",
                                 "θ", "arrows", "hatch", "sectors"}) {
    EXPECT_EQ(words.find(word), std::string::npos) << word << " in " << words;
    EXPECT_NE(others.find(word), std::string::npos) << word;
  }
  for (const std::string word : {"row 5, column 6", "pressure", "kPa", "20 × 30 sensels"}) {
    EXPECT_NE(words.find(word), std::string::npos) << word << " in " << words;
  }
}

TEST(StartPage, ASceneAndARecentSourceAreChosenByTheirNames) {
  const StartChoices choices{{"old.h5"}, {"scenes/demo.toml", "scenes/wave.toml"}};
  FakeGui gui;
  std::string chosen;
  const auto draw = [&] {
    const std::string source = start_page(choices, {0, 0, 500, 1600}, "", 1);
    if (!source.empty()) chosen = source;
  };
  gui.press({"Scenes, simulated as they are opened", "demo"}, draw, "start");
  EXPECT_EQ(chosen, "scenes/demo.toml");
  gui.press({"recent", "old.h5"}, draw, "start");
  EXPECT_EQ(chosen, "old.h5");
}

TEST(ShowContact, MovesTheViewOnlyWhereTheContactIsOutOfSight) {
  FakeAppState fake;
  const View whole = fake.state.look.settings.view;
  show_contact(fake.state, fake.place, {3, 2});
  EXPECT_EQ(fake.state.look.settings.view, whole);
  fake.state.look.settings.view = TopView{{-10, -5}, 500};
  show_contact(fake.state, fake.place, {3, 2});
  EXPECT_EQ(std::get<TopView>(fake.state.look.settings.view).centre_mm, (Vec2{3, 2}));
  EXPECT_FALSE(fake.state.look.view_is_fitted);
}

using Export = io_test::TemporaryDirectory;

TEST(WriteCsv, HasThePillarsOfARectangleThatAreNotIdle) {
  const Export folder;
  FakeAppState fake;
  std::vector<std::uint8_t> status(600, status::kUsable);
  status[3] = 0;
  fake.state.source.field->forces.status = status;
  const auto lines_of = [&](SkinLayout layout, const PillarRect& rect) {
    ShownField field =
        layout == SkinLayout::pillars ? *fake.state.source.field : FakeProducer(layout).produce(7);
    write_csv(folder / "t.csv", field, rect, Replace::anything);
    std::istringstream text(io_test::bytes_of(folder / "t.csv"));
    std::vector<std::string> lines;
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    return lines;
  };
  const auto pillars = lines_of(SkinLayout::pillars, {0, 2, 1, 4});
  EXPECT_EQ(pillars.size(), 1U + 5U);
  EXPECT_TRUE(pillars[2].starts_with("0,0,0,2,")) << pillars[2];
  EXPECT_EQ(lines_of(SkinLayout::pillars, {19, 1000, 0, 1000}).size(), 1U + 30U);
  const auto sensels = lines_of(SkinLayout::sensels, {0, 2, 1, 4});
  EXPECT_EQ(sensels.front(), "frame,time_s,row,col,normal_n,status");
  EXPECT_EQ(sensels.size(), 1U + 6U);
}

TEST(Numbered, NamesSortByFrame) {
  EXPECT_EQ(numbered("a/b.c/field.png", 12, 100), "a/b.c/field_012.png");
  EXPECT_EQ(numbered("field", 3, 9), "field_3");
}

}  // namespace
}  // namespace pillarfield::viewer
