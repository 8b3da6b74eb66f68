#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/force_file.h"
#include "pillarfield/png_file.h"
#include "pillarfield/solver_plan.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {
namespace {

std::vector<std::uint8_t> without_alpha(const Pixels& pixels) {
  const std::size_t count = pixels.rgba.size() / 4;
  std::vector<std::uint8_t> rgb(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      rgb[3 * i + channel] = pixels.rgba[4 * i + channel];
    }
  }
  return rgb;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Pixels& pixels, Replace replace) {
  if (pixels.rgba.size() != std::size_t{4} * pixels.width * pixels.height) {
    throw Error(path.string(), "the picture has no pixels", "set a size above 0");
  }
  pillarfield::write_png(path, {pixels.width, pixels.height, without_alpha(pixels)}, replace);
}

std::filesystem::path numbered(const std::filesystem::path& path, std::uint64_t frame,
                               std::uint64_t frames) {
  const std::size_t digits = std::to_string(frames).size();
  const std::string name =
      fmt::format("{}_{:0{}}{}", path.stem().string(), frame, digits, path.extension().string());
  return path.parent_path() / name;
}

void write_csv(const std::filesystem::path& path, const ShownField& field, const PillarRect& rect,
               Replace replace) {
  ForceFieldView forces = field.forces;
  ForceFileInfo info;
  info.layout = has_pillars(forces) ? SkinLayout::pillars : SkinLayout::sensels;
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
