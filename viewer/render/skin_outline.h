#pragma once

#include <vector>

#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// The outline of pillars on the skin in pixels of `plot`'s picture, without the first point again
/// at the end. Where the skin is bent its sides have points in between. Empty where a part of it is
/// behind the eye.
[[nodiscard]] std::vector<Vec2> outline_of(const PillarRect& rect, const SourceInfo& source,
                                           const RenderSettings& settings, const Viewport& plot);

}  // namespace pillarfield::viewer
