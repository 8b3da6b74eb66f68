#pragma once

#include <span>

#include "viewer/app/panels/format_value.h"
#include "viewer/app/panels/panel_style.h"

namespace pillarfield::viewer {

/// One line for each value: label, value flush right, deviation or interval, unit; in fixed
/// columns.
void value_table(const PanelStyle& style, std::span<const ShownValue> values);

/// Two lines for each value, `width` wide: label and value with its unit; below, flush right, the
/// deviation or interval.
void readouts(const PanelStyle& style, std::span<const ShownValue> values, double width);

/// Width of a table, pixels.
[[nodiscard]] double value_table_width(const PanelStyle& style);

}  // namespace pillarfield::viewer
