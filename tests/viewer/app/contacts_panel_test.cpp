// What the table of contacts says, and what a click on a line and the key do.
#include <gtest/gtest.h>
#include <imgui.h>

#include "tests/viewer/app/fake_session.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/app/panels/contact_words.h"
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

TEST(ContactWords, FollowTheHeads) {
  ContactQuantities contact = a_contact();
  using Words = std::array<std::string, kContactColumns>;
  EXPECT_EQ(contact_words("7", contact),
            (Words{"7", "50.1", "5.00", "–", "unknown", "0 %", "157", "320", "0.457"}));
  contact.ambiguous = 50;
  contact.friction = 0.6;
  contact.slip = SlipState::partial;
  EXPECT_EQ(contact_words("7", contact)[3], "0.60");
  EXPECT_EQ(contact_words("7", contact)[4], "partial");
  EXPECT_EQ(contact_words("7", contact)[5], "25 %");
  contact.resolved = 45;
  EXPECT_EQ(contact_words("all", contact)[5], "25 % / 90 %");
  EXPECT_EQ(contact_words("all", {})[5], "–");
}

TEST(MarkContact, MovesTheViewOnlyWhereTheContactIsOutOfSight) {
  FakeSession fake;
  const View whole = fake.session.look.view;
  const PillarRect extent{2, 4, 20, 24};
  mark_contact(fake.session, fake.place, {3, 2}, extent);
  ASSERT_TRUE(fake.session.region);
  EXPECT_EQ(fake.session.region->rect.col_end, 24U);
  EXPECT_EQ(fake.session.look.view, whole);
  fake.session.look.view = TopView{{-10, -5}, 500};
  mark_contact(fake.session, fake.place, {3, 2}, extent);
  EXPECT_EQ(std::get<TopView>(fake.session.look.view).centre_mm, (Vec2{3, 2}));
  EXPECT_FALSE(fake.session.view_is_fitted);
}

TEST(ShowContacts, TheNextFieldHasThem) {
  FakeSession fake;
  const auto next_field = [&] {
    std::optional<ShownField> field;
    for (int i = 0; i < 2000 && !field; ++i) {
      field = fake.player.take();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return field.value();
  };
  EXPECT_EQ(next_field().contacts, nullptr);
  show_contacts(fake.session, true);
  const ShownField field = next_field();
  EXPECT_TRUE(fake.session.look.contacts);
  ASSERT_NE(field.contacts, nullptr);
  EXPECT_EQ(field.contacts->found.contacts.size(), 1U);
  show_contacts(fake.session, false);
  fake.player.seek(3);
  EXPECT_EQ(next_field().contacts, nullptr);
}

/// An interface that nobody sees.
class ContactsPanel : public testing::Test {
 public:
  ContactsPanel() : context_(ImGui::CreateContext()) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(400, 800);
    unsigned char* pixels = nullptr;
    io.Fonts->GetTexDataAsAlpha8(&pixels, nullptr, nullptr);
    session().look.contacts = true;
    ShownField field = touched_field(0, FakeProducer::kRows, FakeProducer::kCols,
                                     {{{1, 3, 1, 3}, 1}, {{8, 12, 8, 12}, 3}, {{15, 17, 20, 22}}});
    field.contacts = std::make_shared<const ShownContacts>(ContactWatch(1.2).contacts_of(field));
    session().field = field;
  }
  ~ContactsPanel() override { ImGui::DestroyContext(context_); }

  Session& session() { return fake_.session; }

  /// How far down the panel goes.
  float frame() {
    ImGui::GetIO().DeltaTime = 0.02f;
    ImGui::NewFrame();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(380, 700));
    ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoTitleBar);
    contacts_panel(session(), fake_.place);
    const float end = ImGui::GetCursorPosY();
    row_ = ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y;
    ImGui::End();
    ImGui::Render();
    return end;
  }

  /// In the line below so many others; the head is one.
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
  FakeSession fake_;
  ImGuiContext* context_;
  float row_ = 0;
};

TEST_F(ContactsPanel, AClickMarksTheContactOfTheLine) {
  click(2);  // The heaviest, below the head and the sum of all.
  ASSERT_TRUE(session().region);
  EXPECT_EQ(session().region->rect.row_begin, 8U);
  EXPECT_EQ(session().region->rect.col_end, 12U);
  click(3);
  EXPECT_EQ(session().region->rect.row_begin, 1U);
}

TEST_F(ContactsPanel, TheSumOfAllIsNoContact) {
  click(1);
  EXPECT_FALSE(session().region);
}

TEST_F(ContactsPanel, HasNoTableWhereContactsAreNotLookedFor) {
  frame();
  const float with_table = frame();
  session().look.contacts = false;
  EXPECT_LT(frame(), with_table / 2);
  session().look.contacts = true;
  session().field->contacts = nullptr;
  EXPECT_LT(frame(), with_table / 2);
}

}  // namespace
}  // namespace pillarfield::viewer
