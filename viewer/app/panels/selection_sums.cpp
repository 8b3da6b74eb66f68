#include "viewer/app/panels/selection_sums.h"

namespace pillarfield::viewer {
namespace {

bool is_same(const PillarRect& a, const PillarRect& b) {
  return a.row_begin == b.row_begin && a.row_end == b.row_end && a.col_begin == b.col_begin &&
         a.col_end == b.col_end;
}

}  // namespace

const SelectionSums& selection_sums(AppState& state) {
  Selection& selection = *state.selection;
  const std::uint64_t frame = state.field->index;
  if (!selection.cached || selection.cached->frame != frame ||
      !is_same(selection.cached->rect, selection.rect)) {
    const double pitch_mm = state.player->info().skin.pillar_pitch_mm();
    selection.cached = {frame, selection.rect, sums_over(*state.field, selection.rect, pitch_mm)};
  }
  return selection.cached->sums;
}

}  // namespace pillarfield::viewer
