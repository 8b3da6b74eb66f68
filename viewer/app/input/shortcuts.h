#pragma once

#include <array>
#include <span>

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"
#include "viewer/app/input/input.h"

namespace pillarfield::viewer {

/// What was asked of the program rather than of the session.
struct PendingActions {
  bool quit = false;
  bool picture = false;   ///< write the picture on display
  bool sequence = false;  ///< write pictures of all frames
  bool video = false;     ///< make a film of all frames
  bool table = false;     ///< write the pillars in sight as CSV
  bool stop = false;      ///< stop writing
};

/// What a shortcut acts upon.
struct Command {
  AppState& state;
  const FieldPlace& place;
  PendingActions& pending;
};

/// A key as GLFW counts it, with what is held down beside it. Key 0: none.
struct Chord {
  int key = 0;
  Modifiers modifiers;
  friend bool operator==(const Chord&, const Chord&) = default;
};

enum class ShortcutGroup : std::uint8_t { play, show, settings, mark, write };
inline constexpr int kShortcutGroups = 5;
[[nodiscard]] const char* title_of(ShortcutGroup group);

struct Shortcut {
  ShortcutGroup group = ShortcutGroup::play;
  std::array<Chord, 3> chords{};
  const char* keys = "";  ///< for a reader: "Ctrl+P"
  const char* what = "";  ///< for a reader: "write a picture of every frame"
  void (*act)(const Command& command) = nullptr;
};

/// All of them, in the order of the help.
[[nodiscard]] std::span<const Shortcut> shortcuts();

/// What the mouse does in the field, for the help: "drag", "mark a region, or turn the 3-D view".
struct MouseHelp {
  const char* hand = "";
  const char* what = "";
};
[[nodiscard]] std::span<const MouseHelp> mouse_help();

/// Does what the table says of a key; false where it says nothing.
bool dispatch(const Chord& chord, const Command& command);

}  // namespace pillarfield::viewer
