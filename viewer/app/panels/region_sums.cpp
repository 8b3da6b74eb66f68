#include "viewer/app/panels/region_sums.h"

namespace pillarfield::viewer {
namespace {

bool is_same(const PillarRect& a, const PillarRect& b) {
  return a.row_begin == b.row_begin && a.row_end == b.row_end && a.col_begin == b.col_begin &&
         a.col_end == b.col_end;
}

}  // namespace

const RegionSums& region_sums(Session& session) {
  MarkedRegion& region = *session.region;
  const std::uint64_t frame = session.field->index;
  if (!region.kept || region.kept->frame != frame || !is_same(region.kept->rect, region.rect)) {
    const double pitch_mm = session.player->info().skin.pillar_pitch_mm();
    region.kept = {frame, region.rect, sums_over(*session.field, region.rect, pitch_mm)};
  }
  return region.kept->sums;
}

}  // namespace pillarfield::viewer
