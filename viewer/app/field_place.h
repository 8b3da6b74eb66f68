#pragma once

#include <optional>

#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Placement of the picture in the window; with the render settings it maps pixels to the skin.
struct FieldPlace {
  Viewport area;  ///< the picture in the window, pixels
  const SourceInfo* source = nullptr;

  [[nodiscard]] SkinSize skin() const;  ///< mm
  [[nodiscard]] Viewport plot(
      const RenderSettings& settings) const;  ///< the skin in the window, pixels
};

/// Point of the sheet under a window pixel, mm; none outside the skin or the plot.
[[nodiscard]] std::optional<Vec2> sheet_point(const FieldPlace& place,
                                              const RenderSettings& settings, Vec2 pixel);

/// Point of the plane of the sheet in a top view, also outside the skin, for dragging.
[[nodiscard]] Vec2 sheet_point_beyond(const FieldPlace& place, const RenderSettings& settings,
                                      const TopView& view, Vec2 pixel);

[[nodiscard]] std::optional<PillarIndex> pillar_at(const FieldPlace& place,
                                                   const RenderSettings& settings, Vec2 pixel);

/// Pillars under the rectangle with these corners, mm; none outside the skin.
[[nodiscard]] std::optional<PillarRect> pillars_between(const FieldPlace& place, Vec2 corner_mm,
                                                        Vec2 other_mm);

/// Upper left corner of a pillar on the sheet, mm; indices past the last are valid.
[[nodiscard]] Vec2 corner_of(const FieldPlace& place, std::uint32_t row, std::uint32_t col);

/// Window pixel of a point of the sheet; none behind the eye.
[[nodiscard]] std::optional<Vec2> pixel_of(const FieldPlace& place, const RenderSettings& settings,
                                           Vec2 point_mm);

/// Bounding rectangle of the visible pillars.
[[nodiscard]] PillarRect visible_pillars(const FieldPlace& place, const RenderSettings& settings);

}  // namespace pillarfield::viewer
