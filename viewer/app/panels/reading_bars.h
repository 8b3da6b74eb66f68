#pragma once

#include <array>

#include "viewer/app/panels/panel_style.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

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
