#include "viewer/render/scene.h"

#include <algorithm>
#include <cmath>

#include "viewer/render/ground.h"
#include "viewer/style/surface.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

using shader::uint;

constexpr float kSmallestForceFraction =
    0.01f;  ///< of the full force; smaller forces have no arrow

/// From this many pixels per pillar the heat map shows single pillars; the shader's own limit is
/// 1 / 1.5.
constexpr double kSinglePillarPixels = 0.7;

constexpr std::uint32_t kMostReliefTiles = 256;  ///< along a side of the skin

uint pack(const Colour& colour, unsigned alpha = 255) {
  return static_cast<uint>(colour.red) | static_cast<uint>(colour.green) << 8u |
         static_cast<uint>(colour.blue) << 16u | alpha << 24u;
}

/// Offset of a plane in the field's memory, in words.
template <class Value>
uint plane_of(const ShownField& field, std::span<const Value> plane) {
  if (plane.empty()) return shader::kNoPlane;
  const auto* const first = reinterpret_cast<const std::byte*>(plane.data());
  return static_cast<uint>((first - field.pages.data()) / 4);
}

}  // namespace

shader::uvec4 cells_in_sight(const SourceInfo& source, const RenderSettings& settings,
                             const Viewport& plot, uint block) {
  const uint rows = source.skin.element_rows();
  const uint cols = source.skin.element_cols();
  uint row_begin = 0;
  uint row_end = rows;
  uint col_begin = 0;
  uint col_end = cols;
  if (const auto* top = std::get_if<TopView>(&settings.view)) {
    const auto [row_mm, col_mm] = source.skin.element_pitch_mm();
    // One more cell at each side, since arrows may be longer than a cell.
    const auto clamped = [&](double value, uint most) {
      return static_cast<uint>(std::clamp(value, 0.0, static_cast<double>(most)));
    };
    const double half_width = 0.5 * plot.width / top->pixels_per_mm;
    const double half_height = 0.5 * plot.height / top->pixels_per_mm;
    const double air = 2.0 * block;
    col_begin = clamped((top->centre_mm.x - half_width) / col_mm + 0.5 * cols - air, cols);
    col_end = clamped((top->centre_mm.x + half_width) / col_mm + 0.5 * cols + air + 1, cols);
    row_begin = clamped((-top->centre_mm.y - half_height) / row_mm + 0.5 * rows - air, rows);
    row_end = clamped((-top->centre_mm.y + half_height) / row_mm + 0.5 * rows + air + 1, rows);
  }
  // Align cells to the skin, so that they do not move with the view.
  row_begin = row_begin / block * block;
  col_begin = col_begin / block * block;
  const auto cells = [&](uint begin, uint end) {
    return end <= begin ? 0u : (end - begin + block - 1) / block;
  };
  return {row_begin, col_begin, cells(row_begin, row_end), cells(col_begin, col_end)};
}

SkinSize skin_size(const SourceInfo& source) {
  const auto [row_mm, col_mm] = source.skin.element_pitch_mm();
  return {source.skin.element_cols() * col_mm, source.skin.element_rows() * row_mm};
}

double arrow_pitch_mm(const SourceInfo& source) {
  const Pitch pitch_mm = source.skin.element_pitch_mm();
  return std::min(pitch_mm.row_mm, pitch_mm.col_mm);
}

double floor_step_mm(const SkinSize& size) {
  return nice_ceiling(std::max(size.width_mm, size.height_mm) / 10);
}

std::uint32_t arrow_block_of(const RenderSettings& settings, const Viewport& plot,
                             double pitch_mm) {
  return arrow_block(pitch_mm * pixels_per_mm(settings.view, plot),
                     settings.arrow_cell * settings.scale);
}

double full_arrow_n(const RenderSettings& settings) {
  return std::holds_alternative<TopView>(settings.view) ? settings.full_shear_n
                                                        : settings.full_force_n;
}

double arrow_mm_per_newton(const RenderSettings& settings, double pitch_mm, std::uint32_t block) {
  return 1.5 * pitch_mm / (full_arrow_n(settings) * block);
}

shader::Scene scene_of(const ShownField& field, const SourceInfo& source,
                       const RenderSettings& settings, const Viewport& plot) {
  const bool from_above = std::holds_alternative<TopView>(settings.view);
  const SkinSize size = skin_size(source);
  const Pitch pitch_mm = source.skin.element_pitch_mm();
  const double pitch = arrow_pitch_mm(source);
  const Surface surface = from_above ? Surface{} : settings.surface;
  const std::uint32_t block = arrow_block_of(settings, plot, pitch);
  const Relief relief = relief_of(settings, size);
  const std::uint32_t mesh = surface.shape == SurfaceShape::plane ? 1 : 96;
  const auto tiles = [&](std::uint32_t pillars, std::uint32_t flat) {
    return relief.mm_per_newton > 0 ? std::min(pillars, kMostReliefTiles) : flat;
  };
  const auto plane = [&](Uncertainty kind) {
    return plane_of(field, field.forces.uncertainty[kind]);
  };
  const auto narrow = [](double value) { return static_cast<float>(value); };

  shader::Scene scene;
  scene.clip_from_world = clip_from_world(settings.view, surface, size, plot);
  scene.sheet = {narrow(size.width_mm), narrow(size.height_mm), narrow(pitch_mm.col_mm),
                 kpa_per_newton(source.skin)};
  const auto [along_x, along_y, radius_mm, kind] = shader_surface(surface);
  scene.surface = {along_x, along_y, radius_mm, kind};
  scene.grid = {field.forces.rows, field.forces.cols, tiles(field.forces.cols, mesh),
                tiles(field.forces.rows, 1)};
  scene.force = {plane_of(field, field.forces.shear_x), plane_of(field, field.forces.shear_y),
                 plane_of(field, field.forces.normal), plane_of(field, field.forces.status)};
  scene.angles = {plane_of(field, field.forces.magnitude), plane_of(field, field.forces.theta),
                  plane_of(field, field.forces.phi), 0};
  scene.deviation = {plane(Uncertainty::shear_x), plane(Uncertainty::shear_y),
                     plane(Uncertainty::normal), 0};
  scene.span = {plane(Uncertainty::magnitude_low), plane(Uncertainty::magnitude_high),
                plane(Uncertainty::phi_low), plane(Uncertainty::phi_high)};
  scene.incline = {plane(Uncertainty::theta_low), plane(Uncertainty::theta_high), 0, 0};
  scene.readings = {0, static_cast<uint>(field.raw.row_stride), field.raw.data != nullptr ? 1u : 0u,
                    0};
  const double hatch = std::max(std::round(5 * settings.scale), 4.0);
  scene.shown = {settings.hatch ? 1u : 0u, static_cast<uint>(hatch), 0, 0};
  scene.range = {settings.range.low, settings.range.high - settings.range.low,
                 kSmallestForceFraction * narrow(full_arrow_n(settings)), 0};
  scene.viewport = {narrow(plot.x), narrow(plot.y), narrow(plot.width), narrow(plot.height)};
  scene.cells = cells_in_sight(source, settings, plot, block);
  scene.block = {block, from_above ? 1u : 0u, 0, 0};
  scene.arrow = {narrow(arrow_mm_per_newton(settings, pitch, block)), narrow(6 * settings.scale),
                 narrow(1.3 * settings.scale), from_above ? 0.5f : 1.0f};
  const Colour white{255, 255, 255};
  const Colour black{12, 14, 18};
  scene.layer_colours = {pack(white), pack(black), pack(white, 110),
                         pack(colour_of(Special::no_reading, settings.theme))};
  scene.relief = {narrow(relief.mm_per_newton), narrow(relief.most_mm), narrow(pitch_mm.row_mm), 0};
  const double longest = std::max(size.width_mm, size.height_mm);
  scene.ground = {narrow(box_about(size, surface).low.z - 0.01 * longest),
                  narrow(floor_step_mm(size)), narrow(1.6 * longest), 0};
  return scene;
}

HeatKind heat_kind_of(const ShownField& field, const SourceInfo& source,
                      const RenderSettings& settings, const Viewport& plot) {
  const Scale scale = info_of(settings.quantity).scale;
  // Directions and classes have no mean; in a top view all pixels cover equally many pillars.
  const double pixels = arrow_pitch_mm(source) * pixels_per_mm(settings.view, plot);
  const bool near = std::holds_alternative<TopView>(settings.view) && pixels > kSinglePillarPixels;
  const bool has_mean = scale == Scale::sequential || scale == Scale::diverging;
  return {static_cast<uint>(settings.quantity), static_cast<uint>(scale),
          settings.quantity == Quantity::parity ? static_cast<uint>(field.raw.type) : 0u,
          has_mean && !near ? VK_TRUE : VK_FALSE,
          std::holds_alternative<OrbitView>(settings.view) ? VK_TRUE : VK_FALSE};
}

shader::Colours colours_of(const RenderSettings& settings) {
  shader::Colours colours;
  const auto table = table_of(settings.map);
  for (std::size_t i = 0; i < table.size(); ++i) colours.entries.at(i).x = pack(table[i]);
  for (std::size_t i = 0; i < kSpecials; ++i) {
    colours.entries.at(shader::kFirstSpecial + i).x =
        pack(colour_of(static_cast<Special>(i), settings.theme));
  }
  return colours;
}

}  // namespace pillarfield::viewer
