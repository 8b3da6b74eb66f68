#pragma once

#include "shaders/shared.h"
#include "viewer/render/pipelines.h"
#include "viewer/source/field_producer.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Uniform data of one picture.
[[nodiscard]] shader::Scene scene_of(const ShownField& field, const SourceInfo& source,
                                     const RenderSettings& settings, const Viewport& plot);
/// Specialisation of the heat map's shader.
[[nodiscard]] HeatKind heat_kind_of(const ShownField& field, const SourceInfo& source,
                                    const RenderSettings& settings, const Viewport& plot);
[[nodiscard]] shader::Colours colours_of(const RenderSettings& settings);

/// The smaller pitch of the elements, mm: what arrows and pixels of one are measured by.
[[nodiscard]] double arrow_pitch_mm(const SourceInfo& source);

/// First row and column of the cells of `block` x `block` elements in sight, and their numbers.
[[nodiscard]] shader::uvec4 cells_in_sight(const SourceInfo& source, const RenderSettings& settings,
                                           const Viewport& plot, shader::uint block);

/// Size of the skin's sheet, mm.
[[nodiscard]] SkinSize skin_size(const SourceInfo& source);

/// Distance of the lines of the floor in 3-D, mm.
[[nodiscard]] double floor_step_mm(const SkinSize& size);

/// Mean force per pillar, N, whose arrow is 1.5 cells long.
[[nodiscard]] double full_arrow_n(const RenderSettings& settings);

/// Length of arrows, mm per newton, for cells of `block` x `block` pillars.
[[nodiscard]] double arrow_mm_per_newton(const RenderSettings& settings, double pitch_mm,
                                         std::uint32_t block);

/// Pillars along an arrow's cell.
[[nodiscard]] std::uint32_t arrow_block_of(const RenderSettings& settings, const Viewport& plot,
                                           double pitch_mm);

}  // namespace pillarfield::viewer
