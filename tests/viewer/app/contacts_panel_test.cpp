// Contents of the table of contacts; actions of a click on a row and of the key.
#include <gtest/gtest.h>
#include <imgui.h>

#include "tests/viewer/app/fake_app_state.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panels.h"

namespace pillarfield::viewer {
namespace {

ContactQuantities a_contact() {
  ContactQuantities contact;
  contact.pillars = 200;
  contact.normal_n = 50.123;
  contact.shear_x_n = -3;
  contact.shear_y_n = 4;
  contact.area_mm2 = 320;
  contact.peak_n = 0.4567;
  contact.mean_pressure_kpa = 156.6;
  return contact;
}

TEST(FormatContact, FollowTheHeads) {
  ContactQuantities contact = a_contact();
  using Words = std::vector<std::string>;
  const auto format_contact = [](const char* name, const ContactQuantities& of) {
    return viewer::format_contact(name, of, SkinLayout::pillars, kPressureUnits.front());
  };
  EXPECT_EQ(format_contact("7", contact),
            (Words{"7", "50.1", "5.00", "–", "–", "–", "0 %", "157", "285", "320", "0.457"}));
  contact.ambiguous = 50;
  contact.friction = 0.6;
  contact.slip = SlipState::partial;
  EXPECT_EQ(format_contact("7", contact)[3], "0.60");
  EXPECT_EQ(format_contact("7", contact)[4], "partial");
  EXPECT_EQ(format_contact("7", contact)[6], "25 %");
  contact.resolved = 45;
  EXPECT_EQ(format_contact("all", contact)[6], "25 % / 90 %");
  EXPECT_EQ(format_contact("all", {})[6], "–");
}

TEST(FormatContact, TellsWhenItSlips) {
  ContactQuantities contact = a_contact();
  const auto slips_in = [&] {
    return format_contact("7", contact, SkinLayout::pillars, kPressureUnits.front())[5];
  };
  EXPECT_EQ(format_slip_details(contact), "");
  contact.friction_deviation = 0.04;
  EXPECT_EQ(format_slip_details(contact), "standard deviation of µ  0.04");
  contact.slip_forecast = {0.423, 0.31, std::nullopt, {0.004, 0.2, 0.97}};
  EXPECT_EQ(slips_in(), "0.42 s");
  EXPECT_EQ(
      format_slip_details(contact),
      "standard deviation of µ  0.04\nslips in 0.31 s … never (95 %)\nslips within 0.1 s  0 %\n"
      "slips within 0.3 s  20 %\nslips within 1 s  97 %");
  contact.slip_forecast->time_s = 12.6;
  EXPECT_EQ(slips_in(), "13 s");
  contact.slip_forecast->time_s = 1e9;
  EXPECT_EQ(slips_in(), "> 60 s");
  contact.slip_forecast->time_s.reset();
  contact.slip_forecast->low_s.reset();
  EXPECT_EQ(slips_in(), "–");
  EXPECT_NE(format_slip_details(contact).find("does not slip (95 %)"), std::string::npos);
}

TEST(FormatContact, OfSenselsHasNoShear) {
  using Words = std::vector<std::string>;
  const auto [kpa, psi, mmhg] = kPressureUnits;
  EXPECT_EQ(format_contact("7", a_contact(), SkinLayout::sensels, kpa),
            (Words{"7", "50.1", "157", "285", "320", "0.457"}));
  EXPECT_EQ(format_contact("7", a_contact(), SkinLayout::sensels, psi),
            (Words{"7", "50.1", "22.7", "41.4", "320", "0.457"}));
  EXPECT_EQ(contact_columns(SkinLayout::sensels).size(), 6U);
}

TEST(MarkContact, MovesTheViewOnlyWhereTheContactIsOutOfSight) {
  FakeAppState fake;
  const View whole = fake.state.settings.view;
  const PillarRect extent{2, 4, 20, 24};
  mark_contact(fake.state, fake.place, {3, 2}, extent);
  ASSERT_TRUE(fake.state.selection);
  EXPECT_EQ(fake.state.selection->rect.col_end, 24U);
  EXPECT_EQ(fake.state.settings.view, whole);
  fake.state.settings.view = TopView{{-10, -5}, 500};
  mark_contact(fake.state, fake.place, {3, 2}, extent);
  EXPECT_EQ(std::get<TopView>(fake.state.settings.view).centre_mm, (Vec2{3, 2}));
  EXPECT_FALSE(fake.state.view_is_fitted);
}

TEST(ShowContacts, TheNextFieldHasThem) {
  FakeAppState fake;
  const auto next_field = [&] {
    std::optional<ShownField> field;
    for (int i = 0; i < 300'000 && !field; ++i) {
      field = fake.player.take();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return field.value();
  };
  EXPECT_EQ(next_field().contacts, nullptr);
  show_contacts(fake.state, true);
  const ShownField field = next_field();
  EXPECT_TRUE(fake.state.settings.contacts);
  ASSERT_NE(field.contacts, nullptr);
  EXPECT_EQ(field.contacts->found.contacts.size(), 1U);
  show_contacts(fake.state, false);
  fake.player.seek(3);
  EXPECT_EQ(next_field().contacts, nullptr);
}

/// An ImGui context without a display.
class ContactsPanel : public testing::Test {
 public:
  ContactsPanel() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 800);
    unsigned char* pixels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&pixels, nullptr, nullptr);
    state().settings.contacts = true;
    ShownField field = touched_field(0, FakeProducer::kRows, FakeProducer::kCols,
                                     {{{1, 3, 1, 3}, 1}, {{8, 12, 8, 12}, 3}, {{15, 17, 20, 22}}});
    field.contacts = std::make_shared<const ShownContacts>(FieldContacts(1.2).contacts_of(field));
    state().field = field;
  }
  ~ContactsPanel() override { ImGui::DestroyContext(context_); }

  AppState& state() { return fake_.state; }

  /// Draws a frame; returns the height of the panel.
  float frame() {
    ImGui::GetIO().DeltaTime = 0.02f;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(380, 700));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
    contacts_panel(state(), fake_.place);
    const float end = ImGui::GetCursorPosY();
    row_ = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    ImGui::End();
    ImGui::Render();
    return end;
  }

  /// Clicks the row below `line` others, the head included.
  void click(int line) {
    ImGuiIO& io = ImGui::GetIO();
    frame();
    io.MousePos = ImVec2(30, ImGui::GetStyle().WindowPadding.y + row_ * (float(line) + 0.5f));
    frame();
    for (const bool down : {true, false}) {
      io.MouseDown[0] = down;
      frame();
    }
  }

 private:
  FakeAppState fake_;
  ImGuiContext* context_;
  float row_ = 0;
};

TEST_F(ContactsPanel, AClickMarksTheContactOfTheLine) {
  click(2);  // The heaviest, below the head and the total.
  ASSERT_TRUE(state().selection);
  EXPECT_EQ(state().selection->rect.row_begin, 8U);
  EXPECT_EQ(state().selection->rect.col_end, 12U);
  click(3);
  EXPECT_EQ(state().selection->rect.row_begin, 1U);
}

TEST_F(ContactsPanel, TheSumOfAllIsNoContact) {
  click(1);
  EXPECT_FALSE(state().selection);
}

TEST_F(ContactsPanel, HasNoTableWhileContactsAreOff) {
  frame();
  const float with_table = frame();
  state().settings.contacts = false;
  EXPECT_LT(frame(), with_table / 2);
  state().settings.contacts = true;
  state().field->contacts = nullptr;
  EXPECT_LT(frame(), with_table / 2);
}

}  // namespace
}  // namespace pillarfield::viewer
