#pragma once

#include <optional>

#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Where the picture stands in the window, and of what: what a pixel of the window means follows
/// from it and the look.
struct FieldPlace {
  Viewport area;  ///< of the picture in the window, pixels
  const SourceInfo* source = nullptr;

  [[nodiscard]] SkinSize skin() const;  ///< mm
  [[nodiscard]] Viewport plot(
      const RenderSettings& settings) const;  ///< of the skin in the window, pixels
};

/// The point of the sheet under a pixel of the window, mm; none off the skin and off the plot.
[[nodiscard]] std::optional<Vec2> sheet_point(const FieldPlace& place,
                                              const RenderSettings& settings, Vec2 pixel);

/// The same in a top view, for a hand that left the skin while dragging: never none.
[[nodiscard]] Vec2 sheet_point_beyond(const FieldPlace& place, const RenderSettings& settings,
                                      const TopView& view, Vec2 pixel);

[[nodiscard]] std::optional<PillarIndex> pillar_at(const FieldPlace& place,
                                                   const RenderSettings& settings, Vec2 pixel);

/// The pillars under a rectangle with these two corners, mm; none where it is off the skin.
[[nodiscard]] std::optional<PillarRect> pillars_between(const FieldPlace& place, Vec2 corner_mm,
                                                        Vec2 other_mm);

/// Upper left corner of a pillar on the sheet, mm. Pillars past the last have one too: it is where
/// a rectangle ends.
[[nodiscard]] Vec2 corner_of(const FieldPlace& place, std::uint32_t row, std::uint32_t col);

/// Where a point of the sheet appears in the window; none behind the eye.
[[nodiscard]] std::optional<Vec2> pixel_of(const FieldPlace& place, const RenderSettings& settings,
                                           Vec2 point_mm);

/// The pillars to be seen: of a view in perspective the rectangle around them.
[[nodiscard]] PillarRect visible_pillars(const FieldPlace& place, const RenderSettings& settings);

}  // namespace pillarfield::viewer
