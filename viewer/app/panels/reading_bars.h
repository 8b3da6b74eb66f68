#pragma once

#include <array>

#include "viewer/app/panels/panel_style.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"

namespace pillarfield::viewer {

/// A sensel's reading as a bar. Counts as read.
struct ReadingBar {
  double reading = 0;    ///< NaN where it is not known
  double threshold = 0;  ///< above it the sensel is usable, with its own tare and gain
  bool usable = false;
};

/// Of sensels 1..4 of a pillar.
[[nodiscard]] std::array<ReadingBar, 4> reading_bars(const PillarValues& values, PillarIndex pillar,
                                                     const SourceInfo& source);

/// The reading at which a bar is full: the skin's full scale where it has one, that of 8-bit
/// readings, else a round number above readings and thresholds.
[[nodiscard]] double full_bar(const std::array<ReadingBar, 4>& bars, const SourceInfo& source,
                              SenselType type);

/// The size of what draw_reading_bars() draws, at scale 1.
inline constexpr Vec2 kReadingBarsSize{124, 178};

/// Four bars where the sensels lie under their pillar: 2 upper left, 1 upper right, 3 lower left,
/// 4 lower right.
void draw_reading_bars(ImDrawList& list, Vec2 corner, const std::array<ReadingBar, 4>& bars,
                       double full, ImU32 colour, const PanelStyle& style);

}  // namespace pillarfield::viewer
