#pragma once

#include <array>
#include <span>

struct ImDrawList;
struct ImVec2;

namespace pillarfield::viewer {

// Widgets that ImGui lacks, in its style, for its current window.

/// State of a heading.
struct Section {
  bool open;     ///< expanded
  bool dragged;  ///< being dragged away
  bool menu;     ///< right click
};

/// A collapsible heading.
[[nodiscard]] Section section(const char* title);

/// A label on the left; the next control takes the rest of the line.
void labelled(const char* label);

/// A group of exclusive toggle buttons; true if the choice changed.
bool toggle_group(const char* id, std::span<const char* const> words, int& chosen);

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

}  // namespace pillarfield::viewer
