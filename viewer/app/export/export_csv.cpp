#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "pillarfield/component_ends.h"
#include "viewer/app/export/export.h"

namespace pillarfield::viewer {
namespace {

constexpr std::size_t kBlockBytes = 1 << 20;

/// A column of numbers behind the status.
struct Column {
  std::string name;
  std::span<const float> values;
};

/// Whether the ends of components are written, which follow from the uncertainty.
bool has_ends(const ForceFieldView& forces) {
  return !forces.uncertainty[Uncertainty::normal].empty();
}

/// Those that the field has, in the order of docs/formats.md.
std::vector<Column> further_columns(const ForceFieldView& forces) {
  std::vector<Column> columns{
      {"magnitude_n", forces.magnitude}, {"theta_rad", forces.theta}, {"phi_rad", forces.phi}};
  for (std::size_t index = 0; index < kUncertaintyPlanes; ++index) {
    const auto plane = static_cast<Uncertainty>(index);
    const std::string name = name_of(plane);
    const bool angle = name.starts_with("theta") || name.starts_with("phi");
    columns.push_back(
        {fmt::format("uncertainty_{}_{}", name, angle ? "rad" : "n"), forces.uncertainty[plane]});
  }
  std::erase_if(columns, [](const Column& column) { return column.values.empty(); });
  return columns;
}

std::string header(const ForceFieldView& forces, const std::vector<Column>& columns) {
  std::string text = "frame,time_s,row,col,shear_x_n,shear_y_n,normal_n,status";
  for (const Column& column : columns) text += "," + column.name;
  for (std::size_t i = 0; has_ends(forces) && i < kComponentEnds; ++i) {
    text += fmt::format(",uncertainty_{}_n", name_of(static_cast<ComponentEnd>(i)));
  }
  return text + "\n";
}

/// Appends a pillar's line. Numbers have the fewest digits that read back as the same value.
void append_line(std::string& text, const ShownField& field, const std::vector<Column>& columns,
                 PillarIndex pillar) {
  const ForceFieldView& forces = field.forces;
  const std::size_t at = std::size_t{pillar.row} * forces.cols + pillar.col;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{},{},{},{},{},{},{},{}", field.index, field.time_s, pillar.row, pillar.col,
                 forces.shear_x[at], forces.shear_y[at], forces.normal[at], forces.status[at]);
  for (const Column& column : columns) fmt::format_to(out, ",{}", column.values[at]);
  if (has_ends(forces)) {
    for (const float end : component_ends(forces, at, field.direct_point)) {
      fmt::format_to(out, ",{}", end);
    }
  }
  text += '\n';
}

}  // namespace

void write_csv(const std::filesystem::path& path, const ShownField& field, const PillarRect& rect,
               Replace replace) {
  OutputFile file(path, OutputKind::forces, replace);
  const ForceFieldView& forces = field.forces;
  const std::vector<Column> columns = further_columns(forces);
  std::string text = header(forces, columns);
  for (std::uint32_t row = rect.row_begin; row < std::min(rect.row_end, forces.rows); ++row) {
    for (std::uint32_t col = rect.col_begin; col < std::min(rect.col_end, forces.cols); ++col) {
      if (forces.status[std::size_t{row} * forces.cols + col] == 0) continue;
      append_line(text, field, columns, {row, col});
    }
    if (text.size() < kBlockBytes) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  file.commit();
}

}  // namespace pillarfield::viewer
