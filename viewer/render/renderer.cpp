#include "viewer/render/renderer.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "viewer/gpu/device.h"
#include "viewer/render/overlay.h"
#include "viewer/render/scene.h"

namespace pillarfield::viewer {
namespace {

using Usage = vk::BufferUsageFlagBits;
using Place = gpu::Buffer::Place;
using PipelineStage = vk::PipelineStageFlagBits;

template <class Struct>
gpu::Buffer uniform_buffer(const gpu::Device& device) {
  return {device, sizeof(Struct), Usage::eUniformBuffer, Place::host};
}

vk::ClearColorValue paper(Theme theme) {
  const Colour colour = background_of(theme);
  const auto share = [](std::uint8_t value) { return static_cast<float>(value) / 255; };
  return std::array{share(colour.red), share(colour.green), share(colour.blue), 1.0f};
}

void set_viewport(const vk::raii::CommandBuffer& commands, const Viewport& plot) {
  commands.setViewport(
      0, vk::Viewport(static_cast<float>(plot.x), static_cast<float>(plot.y),
                      static_cast<float>(plot.width), static_cast<float>(plot.height), 0, 1));
  commands.setScissor(0, vk::Rect2D({static_cast<int>(plot.x), static_cast<int>(plot.y)},
                                    {static_cast<std::uint32_t>(plot.width),
                                     static_cast<std::uint32_t>(plot.height)}));
}

}  // namespace

Renderer::Renderer(const gpu::Instance& instance, const gpu::Device& device, vk::Extent2D size,
                   double scale)
    : instance_(&instance),
      device_(&device),
      render_pass_(Target::make_render_pass(device)),
      target_(device, *render_pass_, size),
      pipelines_(device, *render_pass_),
      memory_(device),
      overlay_(std::make_unique<GuiContext>(instance, device, *render_pass_, scale)),
      scene_(uniform_buffer<shader::Scene>(device)),
      colours_(uniform_buffer<shader::Colours>(device)) {}

void Renderer::resize(vk::Extent2D size, double scale) {
  if (size != target_.image().size()) target_ = Target(*device_, *render_pass_, size);
  if (scale != overlay_->scale()) {
    overlay_ = std::make_unique<GuiContext>(*instance_, *device_, *render_pass_, scale);
  }
}

void Renderer::update(const shader::Scene& scene, const RenderSettings& settings) {
  std::memcpy(scene_.data(), &scene, sizeof scene);
  const shader::Colours colours = colours_of(settings);
  std::memcpy(colours_.data(), &colours, sizeof colours);
  const std::size_t bytes =
      std::max(std::size_t{scene.cells.z} * scene.cells.w, std::size_t{1}) * sizeof(shader::Cell);
  if (cells_.size() < bytes) {
    cells_ = gpu::Buffer(*device_, bytes, Usage::eStorageBuffer, Place::device);
  }
}

void Renderer::record(const vk::raii::CommandBuffer& commands, const ShownField& field,
                      const SourceInfo& source, const RenderSettings& wanted) {
  const RenderSettings settings = suited_to(source, wanted);
  const vk::Extent2D size = target_.image().size();
  const Layout layout = layout_of(size.width, size.height, settings);
  const shader::Scene scene = scene_of(field, source, settings, layout.plot);
  update(scene, settings);
  pipelines_.bind(
      {scene_.handle(), colours_.handle(), memory_.take(field, commands),
       memory_.take_readings(settings.quantity == Quantity::parity ? field.raw : FrameView{}),
       cells_.handle()});

  const vk::DescriptorSet set = pipelines_.set();
  const std::uint32_t cells = scene.cells.z * scene.cells.w;
  if (settings.arrows && cells != 0) {
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, pipelines_.cells());
    commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, pipelines_.layout(), 0, set,
                                nullptr);
    commands.dispatch((cells + 63) / 64, 1, 1);
    gpu::barrier(commands, {PipelineStage::eComputeShader, vk::AccessFlagBits::eShaderWrite},
                 {PipelineStage::eVertexShader, vk::AccessFlagBits::eShaderRead});
  }

  write_overlay(*overlay_, field, source, settings, layout, size);
  const std::array<vk::ClearValue, 2> clear{paper(settings.theme),
                                            vk::ClearDepthStencilValue(1, 0)};
  commands.beginRenderPass(
      vk::RenderPassBeginInfo(*render_pass_, target_.framebuffer(), {{0, 0}, size}, clear),
      vk::SubpassContents::eInline);
  set_viewport(commands, layout.plot);
  commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_.layout(), 0, set,
                              nullptr);
  if (std::holds_alternative<OrbitView>(settings.view)) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.floor());
    commands.draw(6, 1, 0, 0);
  }
  commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                        pipelines_.heat(heat_kind_of(field, source, settings, layout.plot)));
  commands.draw(6 * scene.grid.z * scene.grid.w, 1, 0, 0);
  if (settings.sectors && scene.block.x == 1 && scene.span.x != shader::kNoPlane && cells != 0) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.sectors());
    commands.draw(6, cells, 0, 0);
  }
  if (settings.arrows && cells != 0) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.arrows());
    commands.draw(6, cells, 0, 0);
  }
  overlay_->draw(commands);
  commands.endRenderPass();
}

}  // namespace pillarfield::viewer
