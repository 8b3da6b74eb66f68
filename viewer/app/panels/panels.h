#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "viewer/app/app_state.h"
#include "viewer/app/field_place.h"
#include "viewer/app/input/shortcuts.h"
#include "viewer/app/source/user_settings.h"
#include "viewer/style/colour_map.h"
#include "viewer/style/view.h"

namespace pillarfield::viewer {

// The panels of the window, drawn into the current ImGui window at its width. Sizes follow
// RenderSettings::scale and the font.

/// Values of the pillar or sensel under the cursor.
void hover_panel(const AppState& state);

/// The inspected pillar, after the paper's testbed interface (Figure 7): readings as bars; theta,
/// phi and magnitude with uncertainty. Of a sensel reading, force and pressure. Selects and removes
/// pins.
void pillar_panel(AppState& state);

/// The contacts of the field on display, heaviest first, and their total. A click brings a
/// contact into sight.
void contacts_panel(AppState& state, const FieldPlace& place);

/// Total force, torque and centre of pressure of the whole skin over time. The wheel zooms, a drag
/// pans, a click seeks.
void time_panel(AppState& state);

/// A sensor: record and tare, rate, losses, faulty sensels.
void sensor_panel(const Command& command);

/// "no frames for 3 s".
[[nodiscard]] std::string silent_words(const LiveStatus& status);

/// Seconds since the last frame of a sensor that has stopped, else 0.
[[nodiscard]] double silence_s(const AppState& state);

/// Dims the field of a sensor that has stopped, and says since when, or what frames come instead.
void draw_silence(const AppState& state, const Viewport& field);

/// Draws the help on mouse and keys, as far as they apply to the source, over the window, and
/// returns its place. Where it does not fit, it scrolls.
[[nodiscard]] Viewport help_overlay(const Viewport& area, const SourceInfo& source);

/// Settings of the picture: quantity, range, layers, view, theme.
void view_panel(const Command& command);

/// Buttons that write files.
void write_panel(const Command& command);

/// The source and, at the end, the last notice or else solver and graphics device. Fills the
/// current ImGui window.
void status_row(const AppState& state, const std::string& gpu);

/// Choices of the start page.
struct StartChoices {
  std::vector<std::string> recent;
  std::vector<std::filesystem::path> scenes;
};

/// The page of a window without a source: pictures of scenes, a line for the name of a source,
/// recent sources, scenes. Returns the source that is chosen; empty: none.
[[nodiscard]] std::string start_page(const StartChoices& choices, const Viewport& area,
                                     const std::string& notice, double scale);

/// Page shown while a source is opened: its name and the present step.
void loading_page(const std::string& source, const std::string& message, const Viewport& area);

/// Controls of the play head in one row: play, step, position, speed, loop, follow. Fills the
/// current ImGui window.
void transport(const Command& command);

}  // namespace pillarfield::viewer
