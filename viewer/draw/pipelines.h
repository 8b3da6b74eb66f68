#pragma once

#include <span>

#include "viewer/gpu/buffer.h"

namespace pillarfield::viewer {

/// What shaders/bindings.glsl calls its blocks, one buffer each.
struct Bindings {
  vk::Buffer scene;
  vk::Buffer colours;
  vk::Buffer field;
  vk::Buffer readings;
  vk::Buffer cells;
};

/// All pipelines of a picture and the one layout and descriptor set that they share.
class Pipelines {
 public:
  Pipelines(const gpu::Device& device, vk::RenderPass render_pass);

  /// Only between submissions: the set is read while commands run.
  void bind(const Bindings& bindings);

  [[nodiscard]] vk::PipelineLayout layout() const { return *layout_; }
  [[nodiscard]] vk::DescriptorSet set() const { return *set_; }
  [[nodiscard]] vk::Pipeline cells() const { return *cells_; }
  [[nodiscard]] vk::Pipeline heat() const { return *heat_; }
  [[nodiscard]] vk::Pipeline arrows() const { return *arrows_; }
  [[nodiscard]] vk::Pipeline fans() const { return *fans_; }

 private:
  const gpu::Device* device_;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet set_ = nullptr;
  vk::raii::Pipeline cells_ = nullptr;
  vk::raii::Pipeline heat_ = nullptr;
  vk::raii::Pipeline arrows_ = nullptr;
  vk::raii::Pipeline fans_ = nullptr;
};

}  // namespace pillarfield::viewer
