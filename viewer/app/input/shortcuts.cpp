#include "viewer/app/input/shortcuts.h"

#include <GLFW/glfw3.h>

#include <algorithm>

#include "viewer/app/input/actions.h"

namespace pillarfield::viewer {
namespace {

using Group = ShortcutGroup;

constexpr Modifiers kShift{true, false};
constexpr Modifiers kControl{false, true};
constexpr std::int64_t kLongStep = 10;

constexpr std::array<Chord, 3> plain(int key, int other = 0, int third = 0) {
  return {Chord{key, {}}, Chord{other, {}}, Chord{third, {}}};
}
constexpr std::array<Chord, 3> with(Modifiers modifiers, int key) {
  return {Chord{key, modifiers}, Chord{}, Chord{}};
}

template <Quantity quantity>
void show(const Command& command) {
  show_quantity(command.state, quantity);
}

template <Quantity quantity>
bool has(const SourceInfo& source) {
  return is_available(quantity, source);
}

/// The key of a quantity.
template <Quantity quantity>
constexpr Shortcut shows(std::array<Chord, 3> chords, const char* keys, const char* description) {
  return {Group::show, chords, keys, description, show<quantity>, has<quantity>};
}

template <bool RenderSettings::*layer>
void toggle(const Command& command) {
  command.state.look.settings.*layer = !(command.state.look.settings.*layer);
}

bool with_pillars(const SourceInfo& source) { return source.skin.has_pillars(); }

/// A layer that shows the shear of pillars.
template <bool RenderSettings::*layer>
void toggle_of_pillars(const Command& command) {
  if (with_pillars(command.state.source.player->info())) return toggle<layer>(command);
  command.state.window.notice.fail("this source has no pillars");
}

template <std::int64_t frames>
void step(const Command& command) {
  command.state.source.player->step(frames);
}

template <bool PendingActions::*request>
void ask(const Command& command) {
  command.pending.*request = true;
}

void toggle_play(const Command& command) {
  Player& player = *command.state.source.player;
  if (player.state().playing) {
    player.pause();
  } else {
    player.play();
  }
}

void go_to_begin(const Command& command) { command.state.source.player->seek(0); }

void go_to_end(const Command& command) {
  command.state.source.player->seek(command.state.source.player->state().frames - 1);
}

void toggle_loop(const Command& command) {
  command.state.source.player->set_loop(!command.state.source.player->state().loops);
}

void toggle_follow(const Command& command) {
  command.state.source.player->set_follow(!command.state.source.player->state().follows);
}

void toggle_theme(const Command& command) {
  Theme& theme = command.state.look.settings.theme;
  theme = theme == Theme::dark ? Theme::light : Theme::dark;
}

void toggle_view(const Command& command) {
  show_orbit(command.state, command.place, !shows_orbit(command.state.look.settings));
}

void toggle_contacts(const Command& command) {
  show_contacts(command.state, !command.state.look.settings.contacts);
}

void take_tare(const Command& command) {
  if (LiveControl* const live = command.state.source.player->live()) {
    live->tare();
    command.state.window.notice = "measuring the tare; touch nothing";
  } else {
    command.state.window.notice.fail("only a sensor has a live tare");
  }
}

/// Closes help, else stops writing, else clears the pins.
void escape(const Command& command) {
  if (command.state.window.show_help) {
    command.state.window.show_help = false;
  } else if (command.state.window.writing) {
    command.pending.stop = true;
  } else {
    command.state.marks.pins.clear();
  }
}

constexpr std::array kShortcuts{
    Shortcut{Group::play, plain(GLFW_KEY_SPACE), "Space", "play or pause", toggle_play},
    Shortcut{Group::play, plain(GLFW_KEY_RIGHT), "→", "one frame on", step<1>},
    Shortcut{Group::play, plain(GLFW_KEY_LEFT), "←", "one frame back", step<-1>},
    Shortcut{Group::play, with(kShift, GLFW_KEY_RIGHT), "Shift+→", "ten frames on",
             step<kLongStep>},
    Shortcut{Group::play, with(kShift, GLFW_KEY_LEFT), "Shift+←", "ten frames back",
             step<-kLongStep>},
    Shortcut{Group::play, plain(GLFW_KEY_HOME), "Home", "first frame", go_to_begin},
    Shortcut{Group::play, plain(GLFW_KEY_END), "End", "last frame", go_to_end},
    Shortcut{Group::play,
             {Chord{GLFW_KEY_EQUAL, {}}, Chord{GLFW_KEY_EQUAL, kShift}, Chord{GLFW_KEY_KP_ADD, {}}},
             "+",
             "faster",
             [](const Command& command) { change_speed(command.state, 1); }},
    Shortcut{Group::play, plain(GLFW_KEY_MINUS, GLFW_KEY_KP_SUBTRACT), "−", "slower",
             [](const Command& command) { change_speed(command.state, -1); }},
    Shortcut{Group::play, plain(GLFW_KEY_L), "L", "loop", toggle_loop},
    Shortcut{Group::play, plain(GLFW_KEY_F), "F", "follow the newest frame", toggle_follow},

    shows<Quantity::normal>(plain(GLFW_KEY_1, GLFW_KEY_KP_1, GLFW_KEY_N), "1, N", "normal force"),
    shows<Quantity::shear>(plain(GLFW_KEY_2, GLFW_KEY_KP_2, GLFW_KEY_S), "2, S", "shear"),
    shows<Quantity::shear_x>(plain(GLFW_KEY_3, GLFW_KEY_KP_3), "3", "shear x"),
    shows<Quantity::shear_y>(plain(GLFW_KEY_4, GLFW_KEY_KP_4), "4", "shear y"),
    shows<Quantity::magnitude>(plain(GLFW_KEY_5, GLFW_KEY_KP_5, GLFW_KEY_M), "5, M", "magnitude"),
    shows<Quantity::theta>(plain(GLFW_KEY_6, GLFW_KEY_KP_6), "6", "θ, inclination"),
    shows<Quantity::phi>(plain(GLFW_KEY_7, GLFW_KEY_KP_7), "7", "φ, direction"),
    shows<Quantity::region>(plain(GLFW_KEY_8, GLFW_KEY_KP_8), "8", "region"),
    shows<Quantity::status>(plain(GLFW_KEY_9, GLFW_KEY_KP_9), "9", "status"),
    shows<Quantity::uncertainty>(plain(GLFW_KEY_0, GLFW_KEY_KP_0), "0", "uncertainty"),
    shows<Quantity::parity>(plain(GLFW_KEY_Y), "Y", "parity residual"),

    shows<Quantity::pressure>(plain(GLFW_KEY_D), "D", "pressure"),

    Shortcut{Group::view, plain(GLFW_KEY_A), "A", "arrows",
             toggle_of_pillars<&RenderSettings::arrows>, with_pillars},
    Shortcut{Group::view, plain(GLFW_KEY_U), "U", "uncertainty sectors",
             toggle_of_pillars<&RenderSettings::sectors>, with_pillars},
    Shortcut{Group::view, plain(GLFW_KEY_X), "X", "hatch ambiguous pillars",
             toggle_of_pillars<&RenderSettings::hatch>, with_pillars},
    Shortcut{Group::view, plain(GLFW_KEY_K), "K", "contacts", toggle_contacts},
    Shortcut{Group::view, plain(GLFW_KEY_V), "V", "top view or 3-D", toggle_view},
    Shortcut{Group::view, plain(GLFW_KEY_B), "B", "height relief in 3-D",
             toggle<&RenderSettings::relief>},
    Shortcut{Group::view, plain(GLFW_KEY_R), "R", "the whole skin",
             [](const Command& command) { reset_view(command.state, command.place); }},
    Shortcut{Group::view, plain(GLFW_KEY_G), "G", "fit the range to this frame",
             [](const Command& command) { fit_range(command.state); }},
    Shortcut{Group::view, plain(GLFW_KEY_T), "T", "dark or light", toggle_theme},
    Shortcut{Group::view, plain(GLFW_KEY_TAB), "Tab", "panels",
             [](const Command& command) {
               command.state.window.show_panels = !command.state.window.show_panels;
             }},

    Shortcut{Group::mark, plain(GLFW_KEY_ESCAPE), "Esc", "clear pins", escape},

    Shortcut{Group::write, plain(GLFW_KEY_P), "P", "write this picture (PNG)",
             ask<&PendingActions::picture>},
    Shortcut{Group::write, with(kControl, GLFW_KEY_M), "Ctrl+M", "write all frames (video)",
             ask<&PendingActions::video>},
    Shortcut{Group::write, with(kControl, GLFW_KEY_R), "Ctrl+R", "record a sensor, or stop",
             ask<&PendingActions::record>},
    Shortcut{Group::play, plain(GLFW_KEY_Z), "Z", "tare of a sensor", take_tare},
    Shortcut{Group::write, plain(GLFW_KEY_C), "C", "write the visible forces (CSV)",
             ask<&PendingActions::table>},
    Shortcut{Group::write, with(kControl, GLFW_KEY_O), "Ctrl+O", "open another source",
             ask<&PendingActions::start>},
    Shortcut{Group::write,
             {Chord{GLFW_KEY_H, {}}, Chord{GLFW_KEY_F1, {}}, Chord{GLFW_KEY_SLASH, kShift}},
             "?, H, F1",
             "this help",
             [](const Command& command) {
               command.state.window.show_help = !command.state.window.show_help;
             }},
    Shortcut{Group::write, plain(GLFW_KEY_Q), "Q", "quit", ask<&PendingActions::quit>},
};

constexpr std::array kMouseHelp{
    MouseHelp{"hover", "values under the cursor"},
    MouseHelp{"click", "pin or unpin a place"},
    MouseHelp{"drag", "move the view; in 3-D turn it"},
    MouseHelp{"right drag, Shift+drag", "move the view"},
    MouseHelp{"wheel", "zoom about the cursor"},
    MouseHelp{"double click", "the whole skin"},
};

}  // namespace

const char* title_of(ShortcutGroup group) {
  constexpr std::array kTitles{"Play", "Show", "View", "Marks", "Write"};
  return kTitles.at(static_cast<std::size_t>(group));
}

bool applies(const Shortcut& shortcut, const SourceInfo& source) {
  return shortcut.suits == nullptr || shortcut.suits(source);
}

std::span<const Shortcut> shortcuts() { return kShortcuts; }

std::span<const MouseHelp> mouse_help() { return kMouseHelp; }

bool dispatch(const Chord& chord, const Command& command) {
  const auto* const found =
      std::find_if(kShortcuts.begin(), kShortcuts.end(), [&](const Shortcut& shortcut) {
        return std::find(shortcut.chords.begin(), shortcut.chords.end(), chord) !=
               shortcut.chords.end();
      });
  if (chord.key == 0 || found == kShortcuts.end()) return false;
  found->act(command);
  return true;
}

}  // namespace pillarfield::viewer
