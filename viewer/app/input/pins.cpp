#include "viewer/app/input/pins.h"

#include <algorithm>
#include <array>

namespace pillarfield::viewer {
namespace {

using PinColours = std::array<Colour, AppState::kMostPins>;

// After Okabe and Ito; lighter on a dark background, darker on a light one.
constexpr PinColours kOnDark{{{86, 180, 233},
                              {240, 167, 50},
                              {38, 198, 150},
                              {222, 140, 185},
                              {240, 228, 88},
                              {236, 112, 60}}};
constexpr PinColours kOnLight{
    {{0, 106, 170}, {196, 122, 0}, {0, 134, 98}, {174, 84, 134}, {110, 100, 0}, {196, 70, 0}}};

bool is_taken(const AppState& state, int number) {
  return std::ranges::any_of(state.pins, [number](const Pin& pin) { return pin.number == number; });
}

}  // namespace

void number_pins(AppState& state) {
  for (Pin& pin : state.pins) {
    if (pin.number != 0) continue;
    int number = 1;
    while (is_taken(state, number)) ++number;
    pin.number = number;
  }
}

PillarRect rect_of(const Pin& pin) {
  return {pin.pillar.row, pin.pillar.row + 1, pin.pillar.col, pin.pillar.col + 1};
}

void inspect_pin(AppState& state, std::size_t index) {
  if (index >= state.pins.size()) return;
  const auto pin = state.pins.begin() + static_cast<std::ptrdiff_t>(index);
  std::rotate(pin, pin + 1, state.pins.end());
}

void remove_pin(AppState& state, std::size_t index) {
  if (index >= state.pins.size()) return;
  state.pins.erase(state.pins.begin() + static_cast<std::ptrdiff_t>(index));
}

Colour pin_colour(int number, Theme theme) {
  const PinColours& colours = theme == Theme::dark ? kOnDark : kOnLight;
  const auto index = static_cast<std::size_t>(std::max(number, 1) - 1);
  return colours[index % colours.size()];
}

}  // namespace pillarfield::viewer
