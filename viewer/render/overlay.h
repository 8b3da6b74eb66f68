#pragma once

#include "viewer/gpu/vulkan.h"
#include "viewer/render/gui_context.h"
#include "viewer/source/field_producer.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Composes the overlay: title, axes in millimetres, colour bar, legends and contacts. `gui.draw()`
/// then draws it.
void write_overlay(const GuiContext& gui, const ShownField& field, const SourceInfo& source,
                   const RenderSettings& settings, const Layout& layout, vk::Extent2D size);

}  // namespace pillarfield::viewer
