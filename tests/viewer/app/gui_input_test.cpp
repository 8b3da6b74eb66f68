// Input while frames are slow: whatever comes between two of them acts, in its order.

#include "viewer/app/input/gui_input.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "tests/viewer/app/fake_app_state.h"

namespace pillarfield::viewer {
namespace {

constexpr std::array kButtons{"one", "two", "three"};

/// A user of a text field, buttons, keys and a picture, who is faster than the frames.
struct FastUser {
  explicit FastUser(unsigned seed) : random(seed) {
    fake.place.area.x = 600;
    frame();
  }

  void act() {
    const unsigned kind = random() % 4;
    if (types && kind < 3) {
      type();
    } else if (kind == 0) {
      click(places[0]);
      types = fresh = true;
    } else if (kind == 1) {
      const std::size_t button = random() % kButtons.size();
      click(places[1 + button]);
      --clicks[button];
      types = false;
    } else if (kind == 2) {
      const auto row = static_cast<std::uint32_t>(random() % 3);
      click(fake.pixel(row, 5));
      pinned[row] = !pinned[row];
      types = false;
    } else if (!types) {
      tap(GLFW_KEY_RIGHT);
      ++taps;
    }
  }

  /// Some of the events come, and a frame is drawn.
  void frame() {
    const std::size_t count = std::min<std::size_t>(random() % 40, events.size());
    const auto end = events.begin() + static_cast<std::ptrdiff_t>(count);
    gui.input.add({events.begin(), end});
    events.erase(events.begin(), end);
    while (const auto event = gui.input.next()) {
      route(*event, fake.command(), fake.place.area, controls);
    }
    gui.frame([&] {
      ImGui::InputText("text", text.data(), text.size(), ImGuiInputTextFlags_AutoSelectAll);
      keep_place(0);
      for (std::size_t i = 0; i < kButtons.size(); ++i) {
        clicks[i] += ImGui::Button(kButtons[i]) ? 1 : 0;
        keep_place(1 + i);
      }
    });
  }

  void keep_place(std::size_t place) {
    const ImVec2 low = ImGui::GetItemRectMin();
    places[place] = {static_cast<double>(low.x) + 5, static_cast<double>(low.y) + 5};
  }
  void click(Vec2 place) {
    events.emplace_back(MotionEvent{place});
    for (const bool pressed : {true, false}) {
      events.emplace_back(ButtonEvent{MouseButton::left, pressed, {}, place, time_s += 1});
    }
  }
  void tap(int key, char letter = 0) {
    events.emplace_back(KeyEvent{key, {}, true, false});
    if (letter != 0) events.emplace_back(TextEvent{static_cast<std::uint32_t>(letter)});
    events.emplace_back(KeyEvent{key, {}, false, false});
  }
  /// The first letter replaces the text, which is selected.
  void type() {
    if (std::exchange(fresh, false)) expected.clear();
    if (!expected.empty() && random() % 4 == 0) {
      tap(GLFW_KEY_BACKSPACE);
      return expected.pop_back();
    }
    expected += static_cast<char>('a' + random() % 26);
    tap(GLFW_KEY_A + expected.back() - 'a', expected.back());
  }

  std::mt19937 random;
  FakeAppState fake;
  FakeGui gui;
  Controls controls;
  std::string expected;    ///< text
  std::uint64_t taps = 0;  ///< of the key of the next frame
  std::array<bool, 3> pinned{};
  std::array<char, 4096> text{};
  std::array<int, kButtons.size()> clicks{};  ///< noticed, less those made
  std::array<Vec2, 1 + kButtons.size()> places{};
  std::vector<InputEvent> events;
  double time_s = 0;
  bool types = false;
  bool fresh = false;  ///< nothing was typed since the click
};

TEST(GuiInput, NoKeyAndNoClickIsLostHoweverSlowFramesAre) {
  constexpr unsigned kUsers = 200;
  std::array<int, 4> lost{};
  for (unsigned seed = 0; seed < kUsers; ++seed) {
    FastUser user(seed);
    for (int i = 0; i < 60; ++i) user.act();
    while (!user.events.empty() || !user.gui.input.is_empty()) user.frame();
    user.frame();
    for (const Pin& pin : user.fake.state.marks.pins) user.pinned[pin.pillar.row] ^= true;
    lost[0] += user.clicks == decltype(user.clicks){} ? 0 : 1;
    lost[1] += user.text.data() == user.expected ? 0 : 1;
    lost[2] += user.fake.player().state().frame == user.taps % FakeProducer::kFrames ? 0 : 1;
    lost[3] += user.pinned == decltype(user.pinned){} ? 0 : 1;
  }
  std::printf("of %u users %d lost clicks, %d letters, %d keys, %d clicks in the field\n", kUsers,
              lost[0], lost[1], lost[2], lost[3]);
  EXPECT_EQ(lost, (std::array<int, 4>{}));
}

}  // namespace
}  // namespace pillarfield::viewer
