#pragma once

#include <span>

#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {

/// A line each: label, value flush right, deviation or interval and unit. The columns stand where
/// they do in every table of the panels, whatever the values.
void value_table(const PanelStyle& style, std::span<const ShownValue> values);

/// The same in two lines each, `width` wide: label and value with its unit, and below the deviation
/// or interval, flush right.
void readouts(const PanelStyle& style, std::span<const ShownValue> values, double width);

/// The width that a table takes, pixels.
[[nodiscard]] double value_table_width(const PanelStyle& style);

}  // namespace pillarfield::viewer
