#pragma once

#include <span>

#include "viewer/app/panels/panel_ink.h"
#include "viewer/app/panels/value_words.h"

namespace pillarfield::viewer {

/// A line each: label, value flush right, deviation or interval and unit. The columns stand where
/// they do in every table of the panels, whatever the values.
void value_table(const PanelInk& ink, std::span<const ShownValue> values);

/// The same in two lines each, `width` wide: label and value with its unit, and below the deviation
/// or interval, flush right.
void readouts(const PanelInk& ink, std::span<const ShownValue> values, double width);

/// The width that a table takes, pixels.
[[nodiscard]] double value_table_width(const PanelInk& ink);

}  // namespace pillarfield::viewer
