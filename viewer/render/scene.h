#pragma once

#include "shaders/shared.h"
#include "viewer/render/pipelines.h"
#include "viewer/source/field_producer.h"
#include "viewer/style/look.h"

namespace pillarfield::viewer {

/// What the shaders are told of one picture.
[[nodiscard]] shader::Scene scene_of(const ShownField& field, const SourceInfo& source,
                                     const Look& look, const Viewport& plot);
/// What the heat map's shader is compiled for.
[[nodiscard]] HeatKind heat_kind_of(const ShownField& field, const SourceInfo& source,
                                    const Look& look, const Viewport& plot);
[[nodiscard]] shader::Colours colours_of(const Look& look);

/// Size of the skin's sheet, mm.
[[nodiscard]] SkinSize skin_size(const SourceInfo& source);

/// The mean force per pillar, N, whose arrow is as long as its cell and a half.
[[nodiscard]] double full_arrow_n(const Look& look);

/// How many millimetres a newton has in arrows of cells of `block` x `block` pillars.
[[nodiscard]] double arrow_mm_per_newton(const Look& look, double pitch_mm, std::uint32_t block);

/// The cell of the arrows of this look.
[[nodiscard]] std::uint32_t arrow_block_of(const Look& look, const Viewport& plot, double pitch_mm);

}  // namespace pillarfield::viewer
