// Named boxes: actions, panel, curves' names; and what the viewer remembers between runs.
#include "viewer/app/named_boxes.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>
#include <optional>

#include "tests/io/sample_files.h"
#include "tests/viewer/app/fake_app_state.h"
#include "viewer/app/input/gui_input.h"
#include "viewer/app/panels/panels.h"
#include "viewer/app/panels/plot.h"
#include "viewer/app/source/user_settings.h"

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

TEST(NamedBoxes, LinesThatAreNoneAreIgnored) {
  for (const std::string line :
       {"", "box", "box 20 30 pillars 1 4 2 9", "box 20 30 pillars 1 4 2 9 ",
        "box 20 30 pillars 1 4 2 9   ", "box 20 30 hairs 1 4 2 9 a", "box 20 30 pillars 4 4 2 9 a",
        "box 20 30 pillars 1 21 2 9 a", "box 20 30 pillars 1 4 -2 9 a",
        "box 20 30 pillars 1 4 2 99999999999 a", "box 20 30 pillars 1 4 2 9 a\x01",
        "box 20 30 pillars 1 4 2 9 \xff", "crate 20 30 pillars 1 4 2 9 a",
        "box 20 30 pillars 1 4 2 9 a name of more than thirty-one bytes"}) {
    EXPECT_EQ(from_text(line).text(), "") << line;
  }
  EXPECT_FALSE(from_text("box 20 30 pillars 1 4 2 9 a").text().empty());
}

TEST(NamedBoxes, AreLimited) {
  std::string text;
  for (int i = 0; i < 100; ++i) text += "box 20 30 pillars 1 4 2 9 a\n";
  EXPECT_EQ(from_text(text).on(skin_of(20, 30)).size(), NamedBoxes::kMost);
  NamedBoxes boxes;
  for (std::uint32_t i = 1; i < 100; ++i) boxes.set(skin_of(i, i), {{"a", {0, 1, 0, 1}, 1}});
  EXPECT_TRUE(boxes.on(skin_of(1, 1)).empty());
  EXPECT_FALSE(boxes.on(skin_of(99, 99)).empty());
}

/// A variable of the environment for the duration of a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    set(value);
  }
  ~Variable() { set(before_ ? before_->c_str() : nullptr); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  void set(const char* value) const {
    if (value == nullptr) {
      unsetenv(name_);
    } else {
      setenv(name_, value, 1);
    }
  }
  const char* name_;
  std::optional<std::string> before_;
};

TEST(UserSettings, RememberBoxesAndSources) {
  const io_test::TemporaryDirectory folder;
  const Variable config("XDG_CONFIG_HOME", (folder / "config").c_str());
  const std::vector<NamedBox> boxes{{"thumb", {1, 4, 2, 9}, 1}};
  io_test::write_bytes(folder / "a.h5", "");
  {
    UserSettings settings;
    settings.boxes.set(skin_of(20, 30), boxes);
    settings.add_recent((folder / "a.h5").string());
    settings.save();
  }
  const UserSettings again;
  EXPECT_EQ(again.boxes.on(skin_of(20, 30)), boxes);
  EXPECT_EQ(again.recent(), std::vector{(folder / "a.h5").string()});
}

TEST(UserSettings, ADamagedOrMissingFileIsNoError) {
  const io_test::TemporaryDirectory folder;
  const Variable config("XDG_CONFIG_HOME", (folder / "").c_str());
  std::filesystem::create_directory(folder / "pillarfield");
  const std::filesystem::path file = folder / "pillarfield" / "viewer.conf";
  const std::string good = "box 20 30 pillars 1 4 2 9 a\n";
  std::string noise;
  for (std::uint64_t i = 0; i < 3000; ++i) noise += static_cast<char>(io_test::number_at(1, i));
  for (const std::string& text :
       {std::string(), noise, "box\nrecent\npanel\n" + noise + "\n" + good}) {
    io_test::write_bytes(file, text);
    const UserSettings settings;
    EXPECT_EQ(settings.boxes.text(), text.ends_with(good) ? good : "");
    settings.save();
    EXPECT_EQ(UserSettings().boxes.text(), settings.boxes.text());
  }
  std::filesystem::remove(file);
  std::filesystem::create_directory(file);
  UserSettings().save();
  EXPECT_TRUE(std::filesystem::is_directory(file));
}

TEST(UserSettings, WithoutAHomeNothingIsKept) {
  const Variable config("XDG_CONFIG_HOME", nullptr);
  const Variable home("HOME", nullptr);
  UserSettings settings;
  settings.boxes.set(skin_of(20, 30), {{"a", {1, 4, 2, 9}, 1}});
  settings.save();
  EXPECT_EQ(UserSettings().boxes.text(), "");
}

TEST(KeepSelection, MakesABoxThatStays) {
  FakeAppState fake;
  keep_selection(fake.state);
  EXPECT_TRUE(fake.state.boxes.empty());
  EXPECT_FALSE(fake.state.notice.empty());
  for (std::uint32_t i = 0; i < NamedBoxes::kMost; ++i) {
    select_pillars(fake.state, {i, i + 1, 3, 9});
    EXPECT_TRUE(dispatch({GLFW_KEY_O, {}}, fake.command()));
    EXPECT_FALSE(fake.state.selection);
  }
  clear_marks(fake.state);
  ASSERT_EQ(fake.state.boxes.size(), NamedBoxes::kMost);
  EXPECT_EQ(fake.state.boxes[1].name, "box 2");
  EXPECT_EQ(fake.state.boxes[1].rect, (PillarRect{1, 2, 3, 9}));
  fake.state.boxes.erase(fake.state.boxes.begin() + 1);
  for (int i = 0; i < 2; ++i) {  // The free number, then none.
    select_pillars(fake.state, {18, 19, 3, 9});
    keep_selection(fake.state);
  }
  EXPECT_EQ(fake.state.boxes.back().name, "box 2");
  EXPECT_TRUE(fake.state.selection);
}

/// An ImGui context without a display.
class Panels : public testing::Test {
 public:
  Panels() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 800);
    unsigned char* pixels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&pixels, nullptr, nullptr);
  }
  ~Panels() override { ImGui::DestroyContext(context_); }
  Panels(const Panels&) = delete;
  Panels& operator=(const Panels&) = delete;

  void frame() {
    input.begin_frame(0.02);
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(284, 700));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
    boxes_panel(fake.state);
    ImGui::End();
    ImGui::Render();
  }

  FakeAppState fake;
  GuiInput input;

 private:
  ImGuiContext* context_;
};

TEST_F(Panels, ANewBoxIsNamedByTyping) {
  select_pillars(fake.state, {1, 3, 2, 9});
  keep_selection(fake.state);
  for (int i = 0; i < 3; ++i) frame();
  ASSERT_TRUE(ImGui::GetIO().WantTextInput);
  for (const char letter : std::string("toe")) {
    input.take(TextEvent{static_cast<std::uint32_t>(letter)});
  }
  frame();
  EXPECT_EQ(fake.state.boxes[0].name, "toe");
  // A tap between two frames is not lost.
  input.take(KeyEvent{GLFW_KEY_ENTER, {}, true, false});
  input.take(KeyEvent{GLFW_KEY_ENTER, {}, false, false});
  for (int i = 0; i < 3; ++i) frame();
  EXPECT_FALSE(ImGui::GetIO().WantTextInput);
  EXPECT_FALSE(ImGui::GetIO().KeysDown[GLFW_KEY_ENTER]);
  EXPECT_EQ(fake.state.boxes[0].name, "toe");
  const SelectionSums& sums = fake.state.boxes[0].cached.value().sums;
  EXPECT_NEAR(sums.normal, 2 * 0.1 * (2 + 3 + 4 + 5 + 6 + 7 + 8), 1e-4);
}

TEST_F(Panels, AClickRemovesABox) {
  for (std::uint32_t i = 0; i < 3; ++i) {
    fake.state.boxes.push_back(
        {"b" + std::to_string(i), {i, i + 1, 0, 5}, static_cast<int>(i) + 1});
  }
  frame();
  frame();
  // The button at the right end of the second line below the head.
  const ImGuiStyle& style = ImGui::GetStyle();
  const float head = ImGui::GetFontSize() + 2 * style.CellPadding.y;
  const float line = ImGui::GetFontSize() + 2 * (style.FramePadding.y + style.CellPadding.y);
  input.take(MotionEvent{{284.0 - static_cast<double>(style.WindowPadding.x) - 6,
                          static_cast<double>(style.WindowPadding.y + head + 1.5f * line)}});
  frame();
  for (const bool down : {true, false}) {
    const ImVec2 at = ImGui::GetIO().MousePos;
    input.take(ButtonEvent{MouseButton::left, down, {}, {double(at.x), double(at.y)}, 0});
    frame();
  }
  ASSERT_EQ(fake.state.boxes.size(), 2U);
  EXPECT_EQ(fake.state.boxes[0].name, "b0");
  EXPECT_EQ(fake.state.boxes[1].name, "b2");
}

TEST(Legend, NoNameEndsBeyondItsChart) {
  for (const double width : {60.0, 150.0, 185.0, 300.0}) {
    for (const int most_lines : {1, 2, 3}) {
      for (std::size_t count = 0; count < 17; ++count) {
        std::vector<double> names;
        for (std::size_t i = 0; i < count; ++i)
          names.push_back(10.0 + 7 * static_cast<double>(i * i % 11));
        const LegendRoom room{58, width, 10, 25, most_lines};
        const Legend legend = legend_of(names, room);
        EXPECT_EQ(legend.names.size() == count, !legend.rest);
        EXPECT_LE(legend.lines, most_lines);
        Legend::Place before{room.title, 0};
        for (std::size_t i = 0; i < legend.names.size(); ++i) {
          const auto [x, line] = legend.names[i];
          EXPECT_LE(x + names[i], width);
          EXPECT_TRUE(line == before.line ? x >= before.x + room.gap
                                          : x == 0 && line == before.line + 1);
          before = {x + names[i], line};
        }
        if (legend.rest && !legend.names.empty()) {
          EXPECT_LE(legend.rest->x + room.rest, width);
        }
      }
    }
  }
}

}  // namespace
}  // namespace pillarfield::viewer
