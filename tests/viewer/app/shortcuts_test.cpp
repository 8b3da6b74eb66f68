// The table of shortcuts: keys are unique, and each has an effect.

#include "viewer/app/input/shortcuts.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tests/viewer/app/fake_app_state.h"

namespace pillarfield::viewer {
namespace {

/// All state that a shortcut may change, for comparison.
auto state_of(const FakeAppState& fake) {
  const AppState& state = fake.state;
  const PlayerState player = fake.player().state();
  const PendingActions& pending = fake.pending;
  return std::tuple(state.look.settings, state.marks.pins.size(), state.window.show_help,
                    state.window.show_panels, player.frame, player.playing, player.loops,
                    player.follows, player.speed, pending.quit, pending.picture, pending.video,
                    pending.table, pending.stop, pending.record, pending.start,
                    state.window.notice);
}

/// A state that every shortcut changes.
void set_up(FakeAppState& fake, Quantity quantity) {
  show_quantity(fake.state, quantity);
  set_range(fake.state, {0, 7.5f});
  fake.player().seek(50);
  toggle_pin(fake.state, {3, 4});
  zoom(fake.state.look.settings.view, fake.place.plot(fake.state.look.settings), {300, 300}, 2);
}

std::vector<Chord> chords_of(const Shortcut& shortcut) {
  std::vector<Chord> chords;
  for (const Chord& chord : shortcut.chords) {
    if (chord.key != 0) chords.push_back(chord);
  }
  return chords;
}

TEST(Shortcuts, NoChordIsThereTwice) {
  std::set<std::tuple<int, bool, bool>> seen;
  for (const Shortcut& shortcut : shortcuts()) {
    for (const Chord& chord : chords_of(shortcut)) {
      const auto [key, modifiers] = chord;
      EXPECT_TRUE(seen.insert({key, modifiers.shift, modifiers.control}).second)
          << shortcut.keys << ": " << shortcut.description;
    }
  }
}

TEST(Shortcuts, EachChordChangesTheState) {
  for (const Shortcut& shortcut : shortcuts()) {
    for (const Chord& chord : chords_of(shortcut)) {
      bool changed = false;
      // At least one of the two quantities differs from the one that a key selects.
      for (const Quantity quantity : {Quantity::normal, Quantity::shear}) {
        FakeAppState fake;
        set_up(fake, quantity);
        const auto before = state_of(fake);
        EXPECT_TRUE(dispatch(chord, fake.command()));
        changed |= state_of(fake) != before;
      }
      EXPECT_TRUE(changed) << shortcut.keys << ": " << shortcut.description;
    }
  }
}

TEST(Shortcuts, OthersDoNothing) {
  FakeAppState fake;
  const auto before = state_of(fake);
  EXPECT_FALSE(dispatch({GLFW_KEY_F12, {}}, fake.command()));
  EXPECT_FALSE(dispatch({GLFW_KEY_Q, {true, true}}, fake.command()));
  EXPECT_FALSE(dispatch({}, fake.command()));
  EXPECT_TRUE(state_of(fake) == before);
}

TEST(Shortcuts, StepsGoOnAndBack) {
  FakeAppState fake;
  fake.player().set_loop(false);
  fake.player().seek(50);
  dispatch({GLFW_KEY_RIGHT, {true, false}}, fake.command());
  EXPECT_EQ(fake.player().state().frame, 60u);
  dispatch({GLFW_KEY_LEFT, {}}, fake.command());
  EXPECT_EQ(fake.player().state().frame, 59u);
  dispatch({GLFW_KEY_END, {}}, fake.command());
  EXPECT_EQ(fake.player().state().frame, FakeProducer::kFrames - 1);
  dispatch({GLFW_KEY_HOME, {}}, fake.command());
  EXPECT_EQ(fake.player().state().frame, 0u);
}

TEST(Shortcuts, EscapeClosesTheHelpFirstAndStopsWritingBeforeItClears) {
  FakeAppState fake;
  toggle_pin(fake.state, {3, 4});
  fake.state.window.show_help = true;
  fake.state.window.writing = true;
  const Chord escape{GLFW_KEY_ESCAPE, {}};
  dispatch(escape, fake.command());
  EXPECT_FALSE(fake.state.window.show_help);
  EXPECT_FALSE(fake.pending.stop);
  dispatch(escape, fake.command());
  EXPECT_TRUE(fake.pending.stop);
  EXPECT_EQ(fake.state.marks.pins.size(), 1u);
  fake.state.window.writing = false;
  dispatch(escape, fake.command());
  EXPECT_TRUE(fake.state.marks.pins.empty());
}

TEST(Shortcuts, AQuantityKeepsItsRange) {
  FakeAppState fake;
  show_quantity(fake.state, Quantity::normal);
  set_range(fake.state, {0.5f, 2.5f});
  show_quantity(fake.state, Quantity::shear_x);
  EXPECT_EQ(fake.state.look.settings.range.low, -fake.state.look.settings.range.high);
  EXPECT_EQ(fake.state.look.settings.map, default_map(Scale::diverging));
  show_quantity(fake.state, Quantity::normal);
  EXPECT_EQ(fake.state.look.settings.range, (Range{0.5f, 2.5f}));
  EXPECT_EQ(fake.state.look.settings.map, default_map(Scale::sequential));
}

}  // namespace
}  // namespace pillarfield::viewer
