#include "viewer/render/pipelines.h"

#include <array>
#include <cstddef>

#include "shaders/arrow_frag.h"
#include "shaders/arrow_vert.h"
#include "shaders/cells_comp.h"
#include "shaders/floor_frag.h"
#include "shaders/floor_vert.h"
#include "shaders/heat_frag.h"
#include "shaders/heat_vert.h"
#include "shaders/shared.h"
#include "shaders/uncertainty_sector_frag.h"
#include "shaders/uncertainty_sector_vert.h"

namespace pillarfield::viewer {
namespace {

using ShaderStage = vk::ShaderStageFlagBits;
using Type = vk::DescriptorType;

struct Binding {
  std::uint32_t index;
  Type type;
  vk::ShaderStageFlags stages;
};

/// Descriptor bindings of all shaders.
constexpr std::array<Binding, 5> kBindings{{
    {shader::kSceneBinding, Type::eUniformBuffer,
     ShaderStage::eVertex | ShaderStage::eFragment | ShaderStage::eCompute},
    {shader::kColoursBinding, Type::eUniformBuffer,
     ShaderStage::eVertex | ShaderStage::eFragment | ShaderStage::eCompute},
    {shader::kFieldBinding, Type::eStorageBuffer,
     ShaderStage::eVertex | ShaderStage::eFragment | ShaderStage::eCompute},
    {shader::kReadingsBinding, Type::eStorageBuffer, ShaderStage::eVertex | ShaderStage::eFragment},
    {shader::kCellsBinding, Type::eStorageBuffer, ShaderStage::eVertex | ShaderStage::eCompute},
}};

vk::raii::DescriptorSetLayout make_set_layout(const gpu::Device& device) {
  std::array<vk::DescriptorSetLayoutBinding, kBindings.size()> bindings;
  for (std::size_t i = 0; i < kBindings.size(); ++i) {
    const Binding& binding = kBindings.at(i);
    bindings.at(i) = {binding.index, binding.type, 1, binding.stages};
  }
  return {device.handle(), vk::DescriptorSetLayoutCreateInfo({}, bindings)};
}

vk::raii::DescriptorPool make_descriptor_pool(const gpu::Device& device) {
  const std::array sizes{vk::DescriptorPoolSize(Type::eUniformBuffer, 2),
                         vk::DescriptorPoolSize(Type::eStorageBuffer, 3)};
  return {device.handle(), vk::DescriptorPoolCreateInfo(
                               vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 1, sizes)};
}

template <std::size_t size>
vk::raii::ShaderModule make_module(const gpu::Device& device, const std::uint32_t (&code)[size]) {
  return {device.handle(), vk::ShaderModuleCreateInfo({}, sizeof(code), code)};
}

/// Use of the depth buffer.
enum class Depth { written, tested };

vk::raii::Pipeline make_pipeline(const gpu::Device& device, vk::PipelineLayout layout,
                                 vk::RenderPass render_pass, const vk::raii::ShaderModule& vertex,
                                 const vk::raii::ShaderModule& fragment, Depth depth,
                                 const vk::SpecializationInfo* constants = nullptr) {
  const std::array stages{
      vk::PipelineShaderStageCreateInfo({}, ShaderStage::eVertex, *vertex, "main", constants),
      vk::PipelineShaderStageCreateInfo({}, ShaderStage::eFragment, *fragment, "main", constants)};
  const vk::PipelineVertexInputStateCreateInfo no_vertices;
  const vk::PipelineInputAssemblyStateCreateInfo triangles({},
                                                           vk::PrimitiveTopology::eTriangleList);
  const vk::PipelineViewportStateCreateInfo viewport({}, 1, nullptr, 1, nullptr);
  vk::PipelineRasterizationStateCreateInfo raster;
  raster.lineWidth = 1;
  const vk::PipelineMultisampleStateCreateInfo one_sample({}, vk::SampleCountFlagBits::e1);
  const vk::PipelineDepthStencilStateCreateInfo depth_state(
      {}, VK_TRUE, depth == Depth::written ? VK_TRUE : VK_FALSE, vk::CompareOp::eLessOrEqual);
  using Factor = vk::BlendFactor;
  using Channel = vk::ColorComponentFlagBits;
  const vk::PipelineColorBlendAttachmentState blend(
      depth == Depth::written ? VK_FALSE : VK_TRUE, Factor::eSrcAlpha, Factor::eOneMinusSrcAlpha,
      vk::BlendOp::eAdd, Factor::eOne, Factor::eOneMinusSrcAlpha, vk::BlendOp::eAdd,
      Channel::eR | Channel::eG | Channel::eB | Channel::eA);
  const vk::PipelineColorBlendStateCreateInfo blending({}, VK_FALSE, {}, blend);
  const std::array dynamic{vk::DynamicState::eViewport, vk::DynamicState::eScissor};
  const vk::PipelineDynamicStateCreateInfo dynamics({}, dynamic);
  const vk::GraphicsPipelineCreateInfo info({}, stages, &no_vertices, &triangles, nullptr,
                                            &viewport, &raster, &one_sample, &depth_state,
                                            &blending, &dynamics, layout, render_pass);
  return {device.handle(), nullptr, info};
}

}  // namespace

Pipelines::Pipelines(const gpu::Device& device, vk::RenderPass render_pass)
    : device_(&device),
      render_pass_(render_pass),
      set_layout_(make_set_layout(device)),
      pool_(make_descriptor_pool(device)),
      heat_vertex_(make_module(device, heat_vert)),
      heat_fragment_(make_module(device, heat_frag)) {
  layout_ =
      vk::raii::PipelineLayout(device.handle(), vk::PipelineLayoutCreateInfo({}, *set_layout_));
  vk::raii::DescriptorSets sets(device.handle(),
                                vk::DescriptorSetAllocateInfo(*pool_, *set_layout_));
  set_ = std::move(sets.front());

  const auto cells = make_module(device, cells_comp);
  const vk::PipelineShaderStageCreateInfo stage({}, ShaderStage::eCompute, *cells, "main");
  cells_ = vk::raii::Pipeline(device.handle(), nullptr,
                              vk::ComputePipelineCreateInfo({}, stage, *layout_));
  arrows_ = make_pipeline(device, *layout_, render_pass, make_module(device, arrow_vert),
                          make_module(device, arrow_frag), Depth::tested);
  sectors_ =
      make_pipeline(device, *layout_, render_pass, make_module(device, uncertainty_sector_vert),
                    make_module(device, uncertainty_sector_frag), Depth::tested);
  floor_ = make_pipeline(device, *layout_, render_pass, make_module(device, floor_vert),
                         make_module(device, floor_frag), Depth::tested);
}

vk::Pipeline Pipelines::heat(const HeatKind& kind) {
  const auto known = heat_.find(kind);
  if (known != heat_.end()) return *known->second;
  constexpr std::size_t kWord = sizeof(std::uint32_t);
  const std::array<vk::SpecializationMapEntry, 5> entries{{
      {shader::kQuantityConstant, offsetof(HeatKind, quantity), kWord},
      {shader::kScaleConstant, offsetof(HeatKind, scale), kWord},
      {shader::kReadingsConstant, offsetof(HeatKind, readings), kWord},
      {shader::kMeansConstant, offsetof(HeatKind, means), kWord},
      {shader::kReliefConstant, offsetof(HeatKind, relief), kWord},
  }};
  const vk::SpecializationInfo constants(entries.size(), entries.data(), sizeof kind, &kind);
  auto made = make_pipeline(*device_, *layout_, render_pass_, heat_vertex_, heat_fragment_,
                            Depth::written, &constants);
  return *heat_.emplace(kind, std::move(made)).first->second;
}

void Pipelines::bind(const Bindings& bindings) {
  const std::array buffers{
      vk::DescriptorBufferInfo(bindings.scene, 0, VK_WHOLE_SIZE),
      vk::DescriptorBufferInfo(bindings.colours, 0, VK_WHOLE_SIZE),
      vk::DescriptorBufferInfo(bindings.field, 0, VK_WHOLE_SIZE),
      vk::DescriptorBufferInfo(bindings.readings, 0, VK_WHOLE_SIZE),
      vk::DescriptorBufferInfo(bindings.cells, 0, VK_WHOLE_SIZE),
  };
  std::array<vk::WriteDescriptorSet, kBindings.size()> writes;
  for (std::size_t i = 0; i < kBindings.size(); ++i) {
    const Binding& binding = kBindings.at(i);
    writes.at(i) = {*set_, binding.index, 0, 1, binding.type, nullptr, &buffers.at(i)};
  }
  device_->handle().updateDescriptorSets(writes, nullptr);
}

}  // namespace pillarfield::viewer
