#pragma once

#include <array>
#include <span>

#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"

struct ImDrawList;
struct ImVec2;

namespace pillarfield::viewer {

// Widgets that ImGui lacks, in its style, for its current window.

/// A heading that folds what follows; true while it is open.
[[nodiscard]] bool section(const char* title);

/// A label on the left; the next control takes the rest of the line.
void labelled(const char* label);

/// Draws an icon in a square of `side` pixels about `middle`.
using Icon = void (*)(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);

/// A square button with an icon, lit while its state is on.
bool icon_button(const char* id, Icon icon, bool lit, const char* help);

namespace icon {
void play(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void pause(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void step_on(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void step_back(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void loop(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void follow(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void less(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void more(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void record(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void tare(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
void question(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
}  // namespace icon

/// One line for each value: label, value flush right, deviation or interval, unit; in fixed
/// columns.
void value_table(const PanelStyle& style, std::span<const ShownValue> values);

/// A sensel's reading as a bar, in raw counts.
struct ReadingBar {
  double reading = 0;    ///< NaN if unknown
  double threshold = 0;  ///< raw reading above which the sensel is usable, by its tare and gain
  bool usable = false;
};

/// Bars of sensels 1..4 of a pillar.
[[nodiscard]] std::array<ReadingBar, 4> reading_bars(const PillarValues& values, PillarIndex pillar,
                                                     const SourceInfo& source);

/// Reading of a full bar: the skin's full scale, else 255 for 8-bit readings, else a round number
/// above readings and thresholds.
[[nodiscard]] double full_bar(const std::array<ReadingBar, 4>& bars, const SourceInfo& source,
                              SenselType type);

/// Size of draw_reading_bars(), at scale 1.
inline constexpr Vec2 kReadingBarsSize{124, 178};

/// Draws four bars at the positions of the sensels: 2 upper left, 1 upper right, 3 lower left, 4
/// lower right.
void draw_reading_bars(ImDrawList& list, Vec2 corner, const std::array<ReadingBar, 4>& bars,
                       double full, ImU32 colour, const PanelStyle& style);

}  // namespace pillarfield::viewer
