#pragma once

#include <array>
#include <span>

struct ImDrawList;
struct ImVec2;

namespace pillarfield::viewer {

// What ImGui has not, drawn in its style and for its current window.

/// A heading of the column that opens and closes; true while it is open.
[[nodiscard]] bool section(const char* title, bool opened = true);

/// Label left, and room for a control right of it as wide as there is.
void labelled(const char* label);

/// Words side by side of which one holds; true where another was chosen.
bool toggle_group(const char* id, std::span<const char* const> words, int& chosen);

/// Draws a sign in a square of `side` pixels whose middle is `middle`.
using Icon = void (*)(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);

/// A square button with a sign; lit where what it stands for is on.
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
void question(ImDrawList& list, const ImVec2& middle, float side, unsigned colour);
}  // namespace icon

}  // namespace pillarfield::viewer
