#include "viewer/app/field_place.h"

#include <algorithm>
#include <cmath>

#include "viewer/render/scene.h"

namespace pillarfield::viewer {
namespace {

/// Pillars [first, second) of `count` that overlap [low, high], in pillar pitches.
std::pair<std::uint32_t, std::uint32_t> touched(double low, double high, std::uint32_t count) {
  const double most = count;
  return {static_cast<std::uint32_t>(std::clamp(std::floor(low), 0.0, most)),
          static_cast<std::uint32_t>(std::clamp(std::ceil(high), 0.0, most))};
}

PillarRect everything(const SourceInfo& source) {
  return {0, source.skin.element_rows(), 0, source.skin.element_cols()};
}

/// Bounding rectangle of the pillars under a grid of pixels, for perspective views.
PillarRect sampled(const FieldPlace& place, const RenderSettings& settings) {
  constexpr int kSteps = 48;
  const Viewport plot = place.plot(settings);
  std::optional<PillarRect> found;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int col = i % kSteps;
    const int row = i / kSteps;
    const Vec2 pixel{plot.x + plot.width * (col + 0.5) / kSteps,
                     plot.y + plot.height * (row + 0.5) / kSteps};
    const auto pillar = pillar_at(place, settings, pixel);
    if (!pillar) continue;
    if (!found) found = {pillar->row, pillar->row + 1, pillar->col, pillar->col + 1};
    found->row_begin = std::min(found->row_begin, pillar->row);
    found->row_end = std::max(found->row_end, pillar->row + 1);
    found->col_begin = std::min(found->col_begin, pillar->col);
    found->col_end = std::max(found->col_end, pillar->col + 1);
  }
  return found.value_or(PillarRect{});
}

}  // namespace

SkinSize FieldPlace::skin() const { return skin_size(*source); }

Viewport FieldPlace::plot(const RenderSettings& settings) const {
  Viewport plot = layout_of(area.width, area.height, settings).plot;
  plot.x += area.x;
  plot.y += area.y;
  return plot;
}

std::optional<Vec2> sheet_point(const FieldPlace& place, const RenderSettings& settings,
                                Vec2 pixel) {
  const Viewport plot = place.plot(settings);
  if (!contains(plot, pixel)) return std::nullopt;
  return pick(settings.view, settings.surface, place.skin(), plot, pixel);
}

Vec2 sheet_point_beyond(const FieldPlace& place, const RenderSettings& settings,
                        const TopView& view, Vec2 pixel) {
  const Viewport plot = place.plot(settings);
  return {view.centre_mm.x + (pixel.x - plot.x - 0.5 * plot.width) / view.pixels_per_mm,
          view.centre_mm.y - (pixel.y - plot.y - 0.5 * plot.height) / view.pixels_per_mm};
}

std::optional<PillarIndex> pillar_at(const FieldPlace& place, const RenderSettings& settings,
                                     Vec2 pixel) {
  const auto point = sheet_point(place, settings, pixel);
  if (!point) return std::nullopt;
  const Skin& skin = place.source->skin;
  const double col = point->x / skin.element_pitch_mm().col_mm + 0.5 * skin.element_cols();
  const double row = 0.5 * skin.element_rows() - point->y / skin.element_pitch_mm().row_mm;
  if (col < 0 || row < 0 || col >= skin.element_cols() || row >= skin.element_rows()) {
    return std::nullopt;
  }
  return PillarIndex{static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(col)};
}

std::optional<PillarRect> pillars_between(const FieldPlace& place, Vec2 corner_mm, Vec2 other_mm) {
  const Skin& skin = place.source->skin;
  const auto [row_mm, col_mm] = skin.element_pitch_mm();
  const double middle_col = 0.5 * skin.element_cols();
  const double middle_row = 0.5 * skin.element_rows();
  const auto [left, right] = std::minmax(corner_mm.x, other_mm.x);
  const auto [below, above] = std::minmax(corner_mm.y, other_mm.y);
  const auto [col_begin, col_end] =
      touched(left / col_mm + middle_col, right / col_mm + middle_col, skin.element_cols());
  const auto [row_begin, row_end] =
      touched(middle_row - above / row_mm, middle_row - below / row_mm, skin.element_rows());
  if (col_begin >= col_end || row_begin >= row_end) return std::nullopt;
  return PillarRect{row_begin, row_end, col_begin, col_end};
}

Vec2 corner_of(const FieldPlace& place, std::uint32_t row, std::uint32_t col) {
  const Skin& skin = place.source->skin;
  return {(col - 0.5 * skin.element_cols()) * skin.element_pitch_mm().col_mm,
          (0.5 * skin.element_rows() - row) * skin.element_pitch_mm().row_mm};
}

std::optional<Vec2> pixel_of(const FieldPlace& place, const RenderSettings& settings,
                             Vec2 point_mm) {
  return project(settings.view, settings.surface, place.skin(), place.plot(settings),
                 std::holds_alternative<TopView>(settings.view)
                     ? Vec3{point_mm.x, point_mm.y, 0}
                     : pose_at(settings.surface, point_mm).position_mm);
}

PillarRect visible_pillars(const FieldPlace& place, const RenderSettings& settings) {
  const auto* const view = std::get_if<TopView>(&settings.view);
  if (view == nullptr) return sampled(place, settings);
  const Viewport plot = place.plot(settings);
  const Vec2 corner = sheet_point_beyond(place, settings, *view, {plot.x, plot.y});
  const Vec2 other =
      sheet_point_beyond(place, settings, *view, {plot.x + plot.width, plot.y + plot.height});
  return pillars_between(place, corner, other).value_or(everything(*place.source));
}

}  // namespace pillarfield::viewer
