// Named boxes: actions, panel, curves' names; and what the viewer remembers between runs.
#include "viewer/app/named_boxes.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/io/sample_files.h"
#include "tests/viewer/app/fake_app_state.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/plot.h"
#include "viewer/app/source/user_settings.h"
#include "viewer/render/contact_marks.h"

namespace pillarfield::viewer {
namespace {

Skin skin_of(std::uint32_t rows, std::uint32_t cols, SkinLayout layout = SkinLayout::pillars) {
  Skin skin;
  skin.layout = layout;
  skin.rows = (layout == SkinLayout::pillars ? 2 : 1) * rows;
  skin.cols = (layout == SkinLayout::pillars ? 2 : 1) * cols;
  return skin;
}

NamedBoxes from_text(const std::string& text) {
  NamedBoxes boxes;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) boxes.add_line(line);
  return boxes;
}

TEST(NamedBoxes, AreOfOneSizeAndLayoutOfSkin) {
  NamedBoxes boxes;
  const std::vector<NamedBox> of_pillars{{"left heel", {1, 4, 2, 9}, 1},
                                         {"Fußballen", {0, 20, 0, 30}, 2}};
  const std::vector<NamedBox> of_sensels{{"  3 7", {19, 20, 29, 30}, 1}};
  std::vector<NamedBox> with_sums = of_pillars;
  with_sums[0].cached.emplace();
  boxes.set(skin_of(20, 30), with_sums);
  EXPECT_FALSE(boxes.on(skin_of(20, 30))[0].cached);
  boxes.set(skin_of(20, 30, SkinLayout::sensels), of_sensels);
  const NamedBoxes again = from_text(boxes.text());
  EXPECT_EQ(again.on(skin_of(20, 30)), of_pillars);
  EXPECT_EQ(again.on(skin_of(20, 30)).back().number, 2);
  EXPECT_EQ(again.on(skin_of(20, 30, SkinLayout::sensels)), of_sensels);
  EXPECT_TRUE(again.on(skin_of(30, 20)).empty());
  boxes.set(skin_of(20, 30), {});
  EXPECT_TRUE(from_text(boxes.text()).on(skin_of(20, 30)).empty());
}

TEST(NamedBoxes, WrongLinesAreIgnoredAndTheirNumberIsLimited) {
  const std::string good = "box 20 30 pillars 1 4 2 9 a";
  for (const std::string line :
       {"", "box", "box 20 30 pillars 1 4 2 9", "box 20 30 pillars 1 4 2 9   ",
        "box 20 30 hairs 1 4 2 9 a", "box 20 30 pillars 4 4 2 9 a", "box 20 30 pillars 1 21 2 9 a",
        "box 20 30 pillars 1 4 -2 9 a", "box 20 30 pillars 1 4 2 99999999999 a",
        "box 20 30 pillars 1 4 2 9 a\x01", "crate 20 30 pillars 1 4 2 9 a",
        "box 20 30 pillars 1 4 2 9 a name of more than thirty-one bytes"}) {
    EXPECT_EQ(from_text(line).text(), "") << line;
  }
  EXPECT_EQ(from_text(good).text(), good + "\n");
  std::string text;
  for (int i = 0; i < 100; ++i) text += good + "\n";
  EXPECT_EQ(from_text(text).on(skin_of(20, 30)).size(), NamedBoxes::kMost);
  NamedBoxes boxes;
  for (std::uint32_t i = 1; i < 100; ++i) boxes.set(skin_of(i, i), {{"a", {0, 1, 0, 1}, 1}});
  EXPECT_TRUE(boxes.on(skin_of(1, 1)).empty());
  EXPECT_FALSE(boxes.on(skin_of(99, 99)).empty());
}

TEST(UserSettings, RememberBoxesAndSourcesWhateverTheFileHolds) {
  const io_test::TemporaryDirectory folder;
  setenv("XDG_CONFIG_HOME", (folder / "config").c_str(), 1);
  const std::vector<NamedBox> boxes{{"thumb", {1, 4, 2, 9}, 1}};
  io_test::write_bytes(folder / "a.h5", "");
  {
    UserSettings settings;
    settings.boxes.set(skin_of(20, 30), boxes);
    settings.add_recent((folder / "a.h5").string());
    settings.save();
  }
  EXPECT_EQ(UserSettings().boxes.on(skin_of(20, 30)), boxes);
  EXPECT_EQ(UserSettings().recent(), std::vector{(folder / "a.h5").string()});
  const std::filesystem::path file = folder / "config" / "pillarfield" / "viewer.conf";
  std::string noise = "box\nrecent\npanel\n";
  for (std::uint64_t i = 0; i < 3000; ++i) noise += static_cast<char>(io_test::number_at(1, i));
  const std::string good = "box 20 30 pillars 1 4 2 9 a\n";
  io_test::write_bytes(file, noise + "\n" + good);
  EXPECT_EQ(UserSettings().boxes.text(), good);
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  UserSettings().save();
  EXPECT_TRUE(std::filesystem::is_directory(file));
  unsetenv("XDG_CONFIG_HOME");
}

TEST(KeepSelection, MakesABoxThatStays) {
  FakeAppState fake;
  keep_selection(fake.state);
  EXPECT_TRUE(fake.state.marks.boxes.empty());
  EXPECT_FALSE(fake.state.window.notice.empty());
  for (std::uint32_t i = 0; i < NamedBoxes::kMost; ++i) {
    select_pillars(fake.state, {i, i + 1, 3, 9});
    EXPECT_TRUE(dispatch({GLFW_KEY_O, {}}, fake.command()));
    EXPECT_FALSE(fake.state.marks.selection);
  }
  clear_marks(fake.state);
  ASSERT_EQ(fake.state.marks.boxes.size(), NamedBoxes::kMost);
  EXPECT_EQ(fake.state.marks.boxes[1].name, "box 2");
  EXPECT_EQ(fake.state.marks.boxes[1].rect, (PillarRect{1, 2, 3, 9}));
  fake.state.marks.boxes.erase(fake.state.marks.boxes.begin() + 1);
  for (int i = 0; i < 2; ++i) {  // The free number, then none.
    select_pillars(fake.state, {18, 19, 3, 9});
    keep_selection(fake.state);
  }
  EXPECT_EQ(fake.state.marks.boxes.back().name, "box 2");
  EXPECT_TRUE(fake.state.marks.selection);
}

TEST(BoxesPanel, NamesANewBoxByTypingAndRemovesOne) {
  FakeAppState fake;
  FakeGui gui;
  const auto draw = [&] { boxes_panel(fake.state); };
  select_pillars(fake.state, {1, 3, 2, 9});
  keep_selection(fake.state);
  for (int i = 0; i < 3; ++i) gui.frame(draw);
  ASSERT_TRUE(GuiInput::wants_text());
  for (const char letter : std::string("toe")) {
    gui.input.take(TextEvent{static_cast<std::uint32_t>(letter)});
  }
  gui.frame(draw);
  EXPECT_EQ(fake.state.marks.boxes[0].name, "toe");
  gui.input.take(KeyEvent{GLFW_KEY_ENTER, {}, true, false});
  gui.frame(draw);
  EXPECT_FALSE(GuiInput::wants_text());
  const SelectionSums& sums = fake.state.marks.boxes[0].cached.value().sums;
  EXPECT_NEAR(sums.normal, 2 * 0.1 * (2 + 3 + 4 + 5 + 6 + 7 + 8), 1e-4);
  fake.state.marks.boxes.push_back({"heel", {3, 4, 0, 5}, 2});
  gui.press({"boxes", 1, "×"}, draw);
  ASSERT_EQ(fake.state.marks.boxes.size(), 1U);
  EXPECT_EQ(fake.state.marks.boxes[0].name, "heel");
}

TEST(Legend, NoNameEndsBeyondItsChart) {
  for (const double width : {60.0, 150.0, 185.0, 300.0}) {
    for (std::size_t count = 0; count < 17; ++count) {
      std::vector<double> names;
      for (std::size_t i = 0; i < count; ++i)
        names.push_back(10.0 + 7 * static_cast<double>(i * i % 11));
      const LegendRoom room{58, width, 10, 25, 2};
      const Legend legend = legend_of(names, room);
      EXPECT_EQ(legend.names.size() == count, !legend.rest);
      EXPECT_LE(legend.lines, room.most_lines);
      Legend::Place before{room.title, 0};
      for (std::size_t i = 0; i < legend.names.size(); ++i) {
        const auto [x, line] = legend.names[i];
        EXPECT_LE(x + names[i], width);
        EXPECT_TRUE(line == before.line ? x >= before.x + room.gap : x == 0);
        before = {x + names[i], line};
      }
    }
  }
}

TEST(LabelBoxes, CoverNoLabelOfAHeavierContact) {
  SourceInfo source;
  source.skin = skin_of(20, 40);
  source.skin.sensel_pitch_mm = 0.5;
  RenderSettings settings;
  settings.view = TopView{{0, 0}, 10};
  const Viewport plot{30, 20, 400, 200};
  const ShownContacts contacts = FieldContacts(1).contacts_of(
      touched_field(0, 20, 40, {{{4, 8, 20, 22}, 3}, {{4, 8, 23, 25}, 2}, {{12, 16, 20, 22}, 1}}));
  const auto marks = contact_marks(contacts, Ground(nullptr, source, settings, plot));
  FakeGui gui;
  gui.frame([&] {
    const std::vector<Viewport> labels = label_boxes(marks, plot, 1);
    ASSERT_EQ(labels.size(), 3U);
    EXPECT_GT(labels[0].width, 0);
    EXPECT_EQ(labels[1].width, 0) << "beside a heavier one";
    EXPECT_GT(labels[2].width, 0);
    EXPECT_FALSE(covers_any(labels[2], {labels[0]}));
  });
}

}  // namespace
}  // namespace pillarfield::viewer
