#include <algorithm>
#include <vector>

#include "pillarfield/force_file.h"
#include "pillarfield/solver_plan.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {

void write_csv(const std::filesystem::path& path, const ShownField& field, const PillarRect& rect,
               Replace replace) {
  ForceFieldView forces = field.forces;
  ForceFileInfo info;
  info.rows = forces.rows;
  info.cols = forces.cols;
  info.angles = !forces.magnitude.empty();
  info.uncertainty = !forces.uncertainty[Uncertainty::normal].empty();
  if (field.direct_point) info.estimator = name_of(Estimator::direct);
  info.segment_point = field.direct_point;
  info.effects.shear_coefficient = field.shear_coefficient;
  // Pillars outside `rect` count as idle, which are omitted.
  std::vector<std::uint8_t> status(forces.status.size());
  const std::uint32_t col_end = std::min(rect.col_end, forces.cols);
  for (std::uint32_t row = rect.row_begin; row < std::min(rect.row_end, forces.rows); ++row) {
    const std::size_t first = std::size_t{row} * forces.cols;
    for (std::size_t at = first + rect.col_begin; at < first + col_end; ++at) {
      status[at] = forces.status[at];
    }
  }
  forces.status = status;
  write_force_csv(path, info, forces, field.index, field.time_s, replace);
}

}  // namespace pillarfield::viewer
