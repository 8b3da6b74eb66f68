#pragma once

#include <array>
#include <span>
#include <string>

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"
#include "viewer/app/input/input.h"

namespace pillarfield::viewer {

/// Actions that the application performs after input handling.
struct PendingActions {
  bool quit = false;
  bool picture = false;  ///< write the picture on display
  bool video = false;    ///< write a video of all frames
  bool table = false;    ///< write the visible pillars as CSV
  bool stop = false;     ///< stop writing
  bool record = false;   ///< start or stop recording a sensor
  bool start = false;    ///< show the start page
  std::string open;      ///< a source to open; empty: none

  /// True if something of the open source is asked for.
  [[nodiscard]] bool anything() const { return picture || video || table || stop || record; }
};

/// Arguments of an action.
struct Command {
  AppState& state;
  const FieldPlace& place;
  PendingActions& pending;
};

/// A GLFW key with modifiers; key 0: none.
struct Chord {
  int key = 0;
  Modifiers modifiers;
  friend bool operator==(const Chord&, const Chord&) = default;
};

enum class ShortcutGroup : std::uint8_t { play, show, view, mark, write };
inline constexpr int kShortcutGroups = 5;
[[nodiscard]] const char* title_of(ShortcutGroup group);

struct Shortcut {
  ShortcutGroup group = ShortcutGroup::play;
  std::array<Chord, 3> chords{};
  const char* keys = "";         ///< for the reader: "Ctrl+P"
  const char* description = "";  ///< for the reader: "write all frames (PNG)"
  void (*act)(const Command& command) = nullptr;
  bool (*suits)(const SourceInfo& source) = nullptr;  ///< null: all
};

/// False for a key of something that the source lacks.
[[nodiscard]] bool applies(const Shortcut& shortcut, const SourceInfo& source);

/// All shortcuts, in the order of the help.
[[nodiscard]] std::span<const Shortcut> shortcuts();

/// Help on a mouse gesture: "wheel", "zoom about the cursor".
struct MouseHelp {
  const char* gesture = "";
  const char* description = "";
};
[[nodiscard]] std::span<const MouseHelp> mouse_help();

/// Performs the action of a key; false without one.
bool dispatch(const Chord& chord, const Command& command);

}  // namespace pillarfield::viewer
