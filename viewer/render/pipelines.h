#pragma once

#include <compare>
#include <map>

#include "viewer/gpu/buffer.h"

namespace pillarfield::viewer {

/// One buffer for each block of shaders/bindings.glsl.
struct Bindings {
  vk::Buffer scene;
  vk::Buffer colours;
  vk::Buffer field;
  vk::Buffer readings;
  vk::Buffer cells;
};

/// Specialisation constants of the heat map's shader, see shaders/shared.h.
struct HeatKind {
  std::uint32_t quantity;
  std::uint32_t scale;
  std::uint32_t readings;
  vk::Bool32 means;
  vk::Bool32 relief;

  // NOLINTNEXTLINE(modernize-use-nullptr): defaulted comparison
  friend auto operator<=>(const HeatKind&, const HeatKind&) = default;
};

/// The pipelines of a picture, with their common layout and descriptor set.
class Pipelines {
 public:
  Pipelines(const gpu::Device& device, vk::RenderPass render_pass);

  /// Call it between submissions only: running commands read the set.
  void bind(const Bindings& bindings);

  [[nodiscard]] vk::PipelineLayout layout() const { return *layout_; }
  [[nodiscard]] vk::DescriptorSet set() const { return *set_; }
  [[nodiscard]] vk::Pipeline cells() const { return *cells_; }
  /// Created on first use and cached.
  [[nodiscard]] vk::Pipeline heat(const HeatKind& kind);
  [[nodiscard]] vk::Pipeline arrows() const { return *arrows_; }
  [[nodiscard]] vk::Pipeline sectors() const { return *sectors_; }
  [[nodiscard]] vk::Pipeline floor() const { return *floor_; }

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
  vk::raii::Pipeline floor_ = nullptr;
};

}  // namespace pillarfield::viewer
