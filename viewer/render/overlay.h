#pragma once

#include <vector>

#include "viewer/gpu/vulkan.h"
#include "viewer/render/gui_context.h"
#include "viewer/source/field_producer.h"
#include "viewer/source/selection.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Composes the overlay: title, axes in millimetres, colour bar, legends and contacts. `gui.draw()`
/// then draws it.
void write_overlay(const GuiContext& gui, const ShownField& field, const SourceInfo& source,
                   const RenderSettings& settings, const Layout& layout, vk::Extent2D size);

/// Outline of a rectangle of pillars, in pixels, as an open-ended polygon; sides on a curved skin
/// have intermediate points. Empty where a part lies behind the eye.
[[nodiscard]] std::vector<Vec2> outline_of(const PillarRect& rect, const SourceInfo& source,
                                           const RenderSettings& settings, const Viewport& plot);

}  // namespace pillarfield::viewer
