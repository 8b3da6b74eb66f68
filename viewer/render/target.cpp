#include "viewer/render/target.h"

#include <array>
#include <cstring>

#include "viewer/gpu/buffer.h"

namespace pillarfield::viewer {

using ImageUsage = vk::ImageUsageFlagBits;

Target::Target(const gpu::Device& device, vk::RenderPass render_pass, vk::Extent2D size)
    : colour_(device, size, kFormat, ImageUsage::eColorAttachment | ImageUsage::eTransferSrc,
              vk::ImageAspectFlagBits::eColor),
      depth_(device, size, kDepthFormat, ImageUsage::eDepthStencilAttachment,
             vk::ImageAspectFlagBits::eDepth) {
  const std::array views{colour_.view(), depth_.view()};
  framebuffer_ = vk::raii::Framebuffer(
      device.handle(),
      vk::FramebufferCreateInfo({}, render_pass, views, size.width, size.height, 1));
}

vk::raii::RenderPass Target::make_render_pass(const gpu::Device& device) {
  using ImageLayout = vk::ImageLayout;
  using Load = vk::AttachmentLoadOp;
  using Store = vk::AttachmentStoreOp;
  using Stage = vk::PipelineStageFlagBits;
  using Access = vk::AccessFlagBits;
  const std::array attachments{
      vk::AttachmentDescription({}, kFormat, vk::SampleCountFlagBits::e1, Load::eClear,
                                Store::eStore, Load::eDontCare, Store::eDontCare,
                                ImageLayout::eUndefined, ImageLayout::eTransferSrcOptimal),
      vk::AttachmentDescription({}, kDepthFormat, vk::SampleCountFlagBits::e1, Load::eClear,
                                Store::eDontCare, Load::eDontCare, Store::eDontCare,
                                ImageLayout::eUndefined,
                                ImageLayout::eDepthStencilAttachmentOptimal)};
  const vk::AttachmentReference colour(0, ImageLayout::eColorAttachmentOptimal);
  const vk::AttachmentReference depth(1, ImageLayout::eDepthStencilAttachmentOptimal);
  const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, nullptr, colour,
                                       nullptr, &depth);
  const auto draws =
      Stage::eColorAttachmentOutput | Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
  const std::array dependencies{
      // Wait for the copy of the last picture, and reuse its depth.
      vk::SubpassDependency(VK_SUBPASS_EXTERNAL, 0, draws | Stage::eTransfer, draws,
                            Access::eDepthStencilAttachmentWrite | Access::eTransferRead,
                            Access::eColorAttachmentWrite | Access::eDepthStencilAttachmentRead |
                                Access::eDepthStencilAttachmentWrite),
      vk::SubpassDependency(0, VK_SUBPASS_EXTERNAL, Stage::eColorAttachmentOutput, Stage::eTransfer,
                            Access::eColorAttachmentWrite, Access::eTransferRead)};
  return {device.handle(), vk::RenderPassCreateInfo({}, attachments, subpass, dependencies)};
}

Pixels read_pixels(const gpu::Device& device, const gpu::Image& image) {
  const vk::Extent2D size = image.size();
  Pixels pixels{size.width, size.height, {}};
  pixels.rgba.resize(std::size_t{4} * size.width * size.height);
  const gpu::Buffer buffer(device, pixels.rgba.size(), vk::BufferUsageFlagBits::eTransferDst,
                           gpu::Buffer::Place::host);
  device.run([&](const vk::raii::CommandBuffer& commands) {
    const vk::BufferImageCopy region(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {},
                                     vk::Extent3D(size, 1));
    commands.copyImageToBuffer(image.handle(), vk::ImageLayout::eTransferSrcOptimal,
                               buffer.handle(), region);
    const vk::MemoryBarrier barrier(vk::AccessFlagBits::eTransferWrite,
                                    vk::AccessFlagBits::eHostRead);
    commands.pipelineBarrier(vk::PipelineStageFlagBits::eTransfer, vk::PipelineStageFlagBits::eHost,
                             {}, barrier, nullptr, nullptr);
  });
  std::memcpy(pixels.rgba.data(), buffer.data(), pixels.rgba.size());
  return pixels;
}

}  // namespace pillarfield::viewer
