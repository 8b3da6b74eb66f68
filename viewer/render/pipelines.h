#pragma once

#include <compare>
#include <map>

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

/// What the heat map's shader is compiled for: the constants of shaders/shared.h.
struct HeatKind {
  std::uint32_t quantity;
  std::uint32_t scale;
  std::uint32_t readings;
  vk::Bool32 means;

  // NOLINTNEXTLINE(modernize-use-nullptr): of comparisons that the compiler writes
  friend auto operator<=>(const HeatKind&, const HeatKind&) = default;
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
  /// Made when it is first asked for, and kept.
  [[nodiscard]] vk::Pipeline heat(const HeatKind& kind);
  [[nodiscard]] vk::Pipeline arrows() const { return *arrows_; }
  [[nodiscard]] vk::Pipeline sectors() const { return *sectors_; }

 private:
  const gpu::Device* device_;
  vk::RenderPass render_pass_;
  vk::raii::DescriptorSetLayout set_layout_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::DescriptorPool pool_ = nullptr;
  vk::raii::DescriptorSet set_ = nullptr;
  vk::raii::Pipeline cells_ = nullptr;
  vk::raii::ShaderModule heat_vertex_;
  vk::raii::ShaderModule heat_fragment_;
  std::map<HeatKind, vk::raii::Pipeline> heat_;
  vk::raii::Pipeline arrows_ = nullptr;
  vk::raii::Pipeline sectors_ = nullptr;
};

}  // namespace pillarfield::viewer
