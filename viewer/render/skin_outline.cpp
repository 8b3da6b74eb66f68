#include "viewer/render/skin_outline.h"

#include <array>

#include "viewer/render/scene.h"

namespace pillarfield::viewer {

std::vector<Vec2> outline_of(const PillarRect& rect, const SourceInfo& source,
                             const RenderSettings& settings, const Viewport& plot) {
  const Skin& skin = source.skin;
  const double pitch = skin.pillar_pitch_mm();
  const double left = (rect.col_begin - 0.5 * skin.pillar_cols()) * pitch;
  const double right = (rect.col_end - 0.5 * skin.pillar_cols()) * pitch;
  const double top = (0.5 * skin.pillar_rows() - rect.row_begin) * pitch;
  const double bottom = (0.5 * skin.pillar_rows() - rect.row_end) * pitch;
  const std::array<Vec2, 5> corners{
      {{left, top}, {right, top}, {right, bottom}, {left, bottom}, {left, top}}};
  const bool from_above = std::holds_alternative<TopView>(settings.view);
  const bool straight = from_above || settings.surface.kind == SurfaceKind::plane;
  const int pieces = straight ? 1 : 32;
  std::vector<Vec2> points;
  for (std::size_t side = 0; side + 1 < corners.size(); ++side) {
    const Vec2& from = corners.at(side);
    const Vec2& to = corners.at(side + 1);
    for (int i = 0; i < pieces; ++i) {
      const double share = static_cast<double>(i) / pieces;
      const Vec2 sheet{from.x + share * (to.x - from.x), from.y + share * (to.y - from.y)};
      const Vec3 place =
          from_above ? Vec3{sheet.x, sheet.y, 0} : frame_at(settings.surface, sheet).position;
      const auto pixel = project(settings.view, settings.surface, skin_size(source), plot, place);
      if (!pixel) return {};
      points.push_back(*pixel);
    }
  }
  return points;
}

}  // namespace pillarfield::viewer
