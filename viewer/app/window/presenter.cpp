#include "viewer/app/window/presenter.h"

#include <algorithm>
#include <array>

namespace pillarfield::viewer {
namespace {

using ImageLayout = vk::ImageLayout;
using Stage = vk::PipelineStageFlagBits;
using Access = vk::AccessFlagBits;

constexpr vk::ImageSubresourceLayers kColour{vk::ImageAspectFlagBits::eColor, 0, 0, 1};
constexpr vk::ImageSubresourceRange kWholeColour{vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1};

/// Render pass that draws over the copied picture and leaves the image ready to present.
vk::raii::RenderPass make_gui_pass(const gpu::Device& device, vk::Format format) {
  const vk::AttachmentDescription attachment(
      {}, format, vk::SampleCountFlagBits::e1, vk::AttachmentLoadOp::eLoad,
      vk::AttachmentStoreOp::eStore, vk::AttachmentLoadOp::eDontCare,
      vk::AttachmentStoreOp::eDontCare, ImageLayout::eTransferDstOptimal,
      ImageLayout::ePresentSrcKHR);
  const vk::AttachmentReference colour(0, ImageLayout::eColorAttachmentOptimal);
  const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, nullptr, colour);
  const std::array dependencies{
      vk::SubpassDependency(VK_SUBPASS_EXTERNAL, 0, Stage::eTransfer, Stage::eColorAttachmentOutput,
                            Access::eTransferWrite,
                            Access::eColorAttachmentRead | Access::eColorAttachmentWrite),
      vk::SubpassDependency(0, VK_SUBPASS_EXTERNAL, Stage::eColorAttachmentOutput,
                            Stage::eBottomOfPipe, Access::eColorAttachmentWrite, {})};
  return {device.handle(), vk::RenderPassCreateInfo({}, attachment, subpass, dependencies)};
}

vk::Offset3D corner_of(vk::Extent2D size) {
  return {static_cast<int>(size.width), static_cast<int>(size.height), 1};
}

}  // namespace

Presenter::Presenter(const gpu::Instance& instance, const gpu::Device& device,
                     vk::SurfaceKHR surface, double scale)
    : instance_(&instance),
      device_(&device),
      chain_(device, surface),
      render_pass_(make_gui_pass(device, chain_.format())),
      renderer_(instance, device, vk::Extent2D{1, 1}, scale),
      gui_(make_gui(scale)),
      pool_(device.handle(),
            {vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family()}),
      buffers_(device.handle(),
               vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1)),
      ready_(device.handle(), vk::SemaphoreCreateInfo()),
      done_(device.handle(), vk::FenceCreateInfo()) {}

bool Presenter::resize(vk::Extent2D window, const std::optional<Place>& place, double scale) {
  // Presentation may still use the semaphores of the old images.
  finish();
  framebuffers_.clear();
  if (!chain_.resize(window)) return false;
  make_framebuffers();
  place_ = place;
  if (place) {
    if (place->size != renderer_.image().size()) has_picture_ = false;
    renderer_.resize(place->size, scale);
  }
  if (scale != gui_->scale()) {
    gui_ = make_gui(scale);
  }
  return true;
}

std::unique_ptr<GuiContext> Presenter::make_gui(double scale) const {
  return std::make_unique<GuiContext>(*instance_, *device_, *render_pass_, scale);
}

void Presenter::make_framebuffers() {
  const vk::Extent2D size = chain_.size();
  for (std::uint32_t i = 0; i < chain_.count(); ++i) {
    const vk::ImageView view = chain_.view(i);
    framebuffers_.emplace_back(
        device_->handle(),
        vk::FramebufferCreateInfo({}, *render_pass_, view, size.width, size.height, 1));
  }
}

void Presenter::clear() {
  finish();
  has_picture_ = false;
  renderer_.memory().forget();
}

bool Presenter::draw(const std::optional<Picture>& picture) {
  const auto index = chain_.acquire(*ready_);
  if (!index) return false;
  record(*index, picture);
  submit(*index);
  chain_.present(*index);
  static_cast<void>(device_->handle().waitForFences(*done_, VK_TRUE, UINT64_MAX));
  device_->handle().resetFences(*done_);
  return true;
}

void Presenter::record(std::uint32_t index, const std::optional<Picture>& picture) {
  const vk::raii::CommandBuffer& commands = buffers_.front();
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  if (picture) {
    renderer_.record(commands, picture->field, picture->source, picture->settings);
    has_picture_ = true;
  }
  copy_picture_or_blank(chain_.image(index));
  draw_gui(index);
  commands.end();
}

/// Discards the old contents: picture and panels cover the whole image, which is blank where the
/// picture is missing.
void Presenter::copy_picture_or_blank(vk::Image image) const {
  const vk::raii::CommandBuffer& commands = buffers_.front();
  const auto wait = [&](vk::AccessFlags before, ImageLayout layout) {
    const vk::ImageMemoryBarrier barrier(before, Access::eTransferWrite, layout,
                                         ImageLayout::eTransferDstOptimal, VK_QUEUE_FAMILY_IGNORED,
                                         VK_QUEUE_FAMILY_IGNORED, image, kWholeColour);
    commands.pipelineBarrier(Stage::eTransfer, Stage::eTransfer, {}, nullptr, nullptr, barrier);
  };
  wait({}, ImageLayout::eUndefined);
  if (!place_ || !has_picture_) {
    commands.clearColorImage(image, ImageLayout::eTransferDstOptimal,
                             vk::ClearColorValue(std::array{0.055f, 0.067f, 0.086f, 1.0f}),
                             kWholeColour);
    wait(Access::eTransferWrite, ImageLayout::eTransferDstOptimal);
  }
  if (place_ && has_picture_) copy_picture(image, renderer_.image(), *place_);
}

void Presenter::copy_picture(vk::Image image, const gpu::Image& picture, const Place& place) const {
  const vk::raii::CommandBuffer& commands = buffers_.front();
  const auto room = [](std::uint32_t all, int from) {
    const auto begin = static_cast<std::uint32_t>(from);
    return all > begin ? all - begin : 0u;
  };
  const vk::Extent2D size{
      std::min(picture.size().width, room(chain_.size().width, place.corner.x)),
      std::min(picture.size().height, room(chain_.size().height, place.corner.y))};
  if (size.width == 0 || size.height == 0) return;
  const vk::Offset3D corner(place.corner.x, place.corner.y, 0);
  if (chain_.format() == Target::kFormat) {
    commands.copyImage(picture.handle(), ImageLayout::eTransferSrcOptimal, image,
                       ImageLayout::eTransferDstOptimal,
                       vk::ImageCopy(kColour, {}, kColour, corner, vk::Extent3D(size, 1)));
  } else {
    const vk::Offset3D end = corner_of(size);
    const std::array<vk::Offset3D, 2> from{vk::Offset3D{}, end};
    const std::array<vk::Offset3D, 2> to{corner,
                                         vk::Offset3D(corner.x + end.x, corner.y + end.y, 1)};
    commands.blitImage(picture.handle(), ImageLayout::eTransferSrcOptimal, image,
                       ImageLayout::eTransferDstOptimal, vk::ImageBlit(kColour, from, kColour, to),
                       vk::Filter::eNearest);
  }
}

void Presenter::draw_gui(std::uint32_t index) const {
  const vk::raii::CommandBuffer& commands = buffers_.front();
  commands.beginRenderPass(
      vk::RenderPassBeginInfo(*render_pass_, *framebuffers_.at(index), {{0, 0}, chain_.size()}),
      vk::SubpassContents::eInline);
  gui_->draw(commands);
  commands.endRenderPass();
}

void Presenter::submit(std::uint32_t index) {
  // The copy is the first access to the image.
  const vk::PipelineStageFlags waits = Stage::eTransfer;
  const vk::Semaphore ready = *ready_;
  const vk::Semaphore drawn = chain_.drawn(index);
  const vk::CommandBuffer commands = *buffers_.front();
  device_->queue().submit(vk::SubmitInfo(ready, waits, commands, drawn), *done_);
}

}  // namespace pillarfield::viewer
