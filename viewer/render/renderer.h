#pragma once

#include "shaders/shared.h"
#include "viewer/render/field_memory.h"
#include "viewer/render/gui_context.h"
#include "viewer/render/pipelines.h"
#include "viewer/render/target.h"
#include "viewer/source/field_producer.h"
#include "viewer/style/render_settings.h"

namespace pillarfield::viewer {

/// Draws pictures of fields (heat map, arrows, axes, legends) into an image, for a window or a
/// file.
class Renderer {
 public:
  Renderer(const gpu::Instance& instance, const gpu::Device& device, vk::Extent2D size,
           double scale);

  /// Records the drawing of a picture. `shown` must stay alive until the commands are complete;
  /// commands recorded earlier must be complete.
  void record(const vk::raii::CommandBuffer& commands, const ShownField& field,
              const SourceInfo& source, const RenderSettings& wanted);

  /// Changes size and scale; recorded commands must be complete.
  void resize(vk::Extent2D size, double scale);

  /// The picture, ready to be copied once the commands are complete.
  [[nodiscard]] const gpu::Image& image() const { return target_.image(); }

  [[nodiscard]] FieldMemory& memory() { return memory_; }

 private:
  void update(const shader::Scene& scene, const RenderSettings& settings);

  const gpu::Instance* instance_;
  const gpu::Device* device_;
  vk::raii::RenderPass render_pass_;
  Target target_;
  Pipelines pipelines_;
  FieldMemory memory_;
  std::unique_ptr<GuiContext> overlay_;
  gpu::Buffer scene_;
  gpu::Buffer colours_;
  gpu::Buffer cells_;
};

}  // namespace pillarfield::viewer
