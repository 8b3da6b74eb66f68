// Choosing and removing pins by mouse in the pillar panel.
#include <gtest/gtest.h>
#include <imgui.h>

#include "tests/viewer/app/made_field.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

class NoFields final : public FieldProducer {
 public:
  explicit NoFields(const MadeField& made) : made_(made), info_(made.source()) {}
  [[nodiscard]] const SourceInfo& info() const override { return info_; }
  [[nodiscard]] ShownField produce(std::uint64_t /*index*/) override { return made_.shown(); }

 private:
  const MadeField& made_;
  SourceInfo info_;
};

/// An ImGui context without a display.
class PillarPanel : public testing::Test {
 public:
  PillarPanel() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 800);
    unsigned char* pixels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&pixels, nullptr, nullptr);
    state_.player = &player_;
    state_.field = made_.shown();
    for (std::uint32_t i = 0; i < 3; ++i) state_.pins.push_back({{10 + i, 20}});
  }
  ~PillarPanel() override { ImGui::DestroyContext(context_); }

  void frame() {
    ImGui::GetIO().DeltaTime = 0.02f;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(kWidth, 700));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
    pillar_panel(state_);
    side_ = ImGui::GetTextLineHeight() + 6;
    ImGui::End();
    ImGui::Render();
  }

  void click(float x) {
    ImGuiIO& io = ImGui::GetIO();
    frame();
    io.MousePos = ImVec2(x, ImGui::GetStyle().WindowPadding.y + side_ / 2);
    frame();
    for (const bool down : {true, false}) {
      io.MouseDown[0] = down;
      frame();
    }
    io.MousePos = ImVec2(-1, -1);
    frame();
  }
  void click_button(int number) {
    frame();
    click(ImGui::GetStyle().WindowPadding.x + static_cast<float>(number - 1) * (side_ + 6) +
          side_ / 2);
  }
  void click_remove() {
    frame();
    click(kWidth - ImGui::GetStyle().WindowPadding.x - side_ / 2);
  }
  [[nodiscard]] std::vector<int> numbers() const {
    std::vector<int> found;
    for (const Pin& pin : state_.pins) found.push_back(pin.number);
    return found;
  }

 protected:
  static constexpr float kWidth = 340;
  ImGuiContext* context_;
  float side_ = 0;
  MadeField made_;
  FilePlayer player_{std::make_unique<NoFields>(made_)};
  AppState state_;
};

TEST_F(PillarPanel, AClickOnANumberInspectsItsPin) {
  frame();
  EXPECT_EQ(numbers(), (std::vector<int>{1, 2, 3}));
  click_button(1);
  EXPECT_EQ(numbers(), (std::vector<int>{2, 3, 1}));
  click_button(3);  // Buttons keep their positions.
  EXPECT_EQ(numbers(), (std::vector<int>{2, 1, 3}));
}

TEST_F(PillarPanel, TheCrossRemovesTheInspectedPinUntilNoneIsLeft) {
  click_button(2);
  click_remove();
  EXPECT_EQ(numbers(), (std::vector<int>{1, 3}));
  click_remove();
  EXPECT_EQ(numbers(), (std::vector<int>{1}));
  click_remove();
  frame();
  EXPECT_TRUE(state_.pins.empty());
}

TEST_F(PillarPanel, PinsOutsideTheFieldDoNotBreakIt) {
  state_.pins.push_back({{1000, 1000}});
  frame();
  state_.field.reset();
  frame();
  EXPECT_EQ(state_.pins.size(), 4u);
}

TEST_F(PillarPanel, SumsOfTheSelectionFollowRectangleAndFrame) {
  state_.selection = Selection{{4, 20, 8, 30}};
  const double pitch_mm = made_.skin.pillar_pitch_mm();
  const double first = selection_sums(state_).normal;
  EXPECT_EQ(first, sums_over(*state_.field, {4, 20, 8, 30}, pitch_mm).normal);
  state_.selection->rect.row_end = 14;
  const double second = selection_sums(state_).normal;
  EXPECT_EQ(second, sums_over(*state_.field, {4, 14, 8, 30}, pitch_mm).normal);
  EXPECT_LT(second, first);

  for (float& normal : made_.forces.normal) normal *= 2;
  EXPECT_EQ(selection_sums(state_).normal, second);  // Cached for the frame.
  ++state_.field->index;
  EXPECT_NEAR(selection_sums(state_).normal, 2 * second, 1e-6);
}

}  // namespace
}  // namespace pillarfield::viewer
