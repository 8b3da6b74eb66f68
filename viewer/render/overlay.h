#pragma once

#include "viewer/gpu/vulkan.h"
#include "viewer/render/interface.h"
#include "viewer/source/field_producer.h"
#include "viewer/style/look.h"

namespace pillarfield::viewer {

/// Writes what stands around and upon the field: title, axes in millimetres, the colour bar with
/// its numbers and unit, the meaning of colours and arrows, and contacts. `interface.draw()` then
/// draws it.
void write_overlay(const Interface& interface, const ShownField& field, const SourceInfo& source,
                   const Look& look, const Layout& layout, vk::Extent2D size);

}  // namespace pillarfield::viewer
