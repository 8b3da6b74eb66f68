#pragma once

#include "shaders/shared.h"
#include "viewer/render/pipelines.h"
#include "viewer/source/field_producer.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// What the shaders are told of one picture.
[[nodiscard]] shader::Scene scene_of(const ShownField& field, const SourceInfo& source,
                                     const RenderSettings& settings, const Viewport& plot);
/// What the heat map's shader is compiled for.
[[nodiscard]] HeatKind heat_kind_of(const ShownField& field, const SourceInfo& source,
                                    const RenderSettings& settings, const Viewport& plot);
[[nodiscard]] shader::Colours colours_of(const RenderSettings& settings);

/// Size of the skin's sheet, mm.
[[nodiscard]] SkinSize skin_size(const SourceInfo& source);

/// The mean force per pillar, N, whose arrow is as long as its cell and a half.
[[nodiscard]] double full_arrow_n(const RenderSettings& settings);

/// How many millimetres a newton has in arrows of cells of `block` x `block` pillars.
[[nodiscard]] double arrow_mm_per_newton(const RenderSettings& settings, double pitch_mm,
                                         std::uint32_t block);

/// The cell of the arrows of this look.
[[nodiscard]] std::uint32_t arrow_block_of(const RenderSettings& settings, const Viewport& plot,
                                           double pitch_mm);

}  // namespace pillarfield::viewer
