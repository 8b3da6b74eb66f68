#include "viewer/gpu/swap_chain.h"

#include <algorithm>

#include "pillarfield/error.h"

namespace pillarfield::viewer::gpu {
namespace {

constexpr const char* kMend = "choose another device with --gpu, or render to a file: --headless";
constexpr std::uint64_t kPatienceNanoseconds = 1'000'000'000;

vk::SurfaceFormatKHR choose_format(const Device& device, vk::SurfaceKHR surface) {
  const auto formats = device.physical().getSurfaceFormatsKHR(surface);
  // Prefer the picture's format, which needs no conversion.
  for (const auto wanted : {vk::Format::eR8G8B8A8Unorm, vk::Format::eB8G8R8A8Unorm}) {
    const auto found =
        std::find_if(formats.begin(), formats.end(), [&](const vk::SurfaceFormatKHR& candidate) {
          return candidate.format == wanted &&
                 candidate.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear;
        });
    if (found != formats.end()) return *found;
  }
  throw Error(device.name(), "its window surfaces lack an 8-bit UNORM format", kMend);
}

/// A mode without tearing; mailbox, where available, does not block.
vk::PresentModeKHR choose_mode(const Device& device, vk::SurfaceKHR surface) {
  const auto modes = device.physical().getSurfacePresentModesKHR(surface);
  const bool has_mailbox =
      std::find(modes.begin(), modes.end(), vk::PresentModeKHR::eMailbox) != modes.end();
  return has_mailbox ? vk::PresentModeKHR::eMailbox : vk::PresentModeKHR::eFifo;
}

void require_copies(const Device& device, vk::SurfaceKHR surface) {
  const auto usages = device.physical().getSurfaceCapabilitiesKHR(surface).supportedUsageFlags;
  if (usages & vk::ImageUsageFlagBits::eTransferDst) return;
  throw Error(device.name(), "its window images are not copy destinations", kMend);
}

/// Extent of a surface that takes the size of its images.
constexpr std::uint32_t kUndefinedExtent = 0xffffffff;

vk::Extent2D size_of(const vk::SurfaceCapabilitiesKHR& can, vk::Extent2D preferred) {
  if (can.currentExtent.width != kUndefinedExtent) return can.currentExtent;
  if (preferred.width == 0 || preferred.height == 0) return {0, 0};
  return {std::clamp(preferred.width, can.minImageExtent.width, can.maxImageExtent.width),
          std::clamp(preferred.height, can.minImageExtent.height, can.maxImageExtent.height)};
}

std::uint32_t count_of(const vk::SurfaceCapabilitiesKHR& can) {
  const std::uint32_t preferred = std::max(can.minImageCount + 1, 3u);
  return can.maxImageCount == 0 ? preferred : std::min(preferred, can.maxImageCount);
}

vk::CompositeAlphaFlagBitsKHR alpha_of(const vk::SurfaceCapabilitiesKHR& can) {
  using Alpha = vk::CompositeAlphaFlagBitsKHR;
  for (const auto alpha : {Alpha::eOpaque, Alpha::eInherit, Alpha::ePreMultiplied}) {
    if (can.supportedCompositeAlpha & alpha) return alpha;
  }
  return Alpha::ePostMultiplied;
}

}  // namespace

SwapChain::SwapChain(const Device& device, vk::SurfaceKHR surface)
    : device_(&device), surface_(surface), mode_(choose_mode(device, surface)) {
  const vk::SurfaceFormatKHR format = choose_format(device, surface);
  format_ = format.format;
  colour_space_ = format.colorSpace;
  require_copies(device, surface);
}

bool SwapChain::resize(vk::Extent2D preferred) {
  const auto can = device_->physical().getSurfaceCapabilitiesKHR(surface_);
  size_ = size_of(can, preferred);
  views_.clear();
  images_.clear();
  drawn_.clear();
  if (size_.width == 0 || size_.height == 0) {
    stale_ = true;
    return false;
  }
  const auto usage =
      vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferDst;
  const vk::SwapchainCreateInfoKHR info({}, surface_, count_of(can), format_, colour_space_, size_,
                                        1, usage, vk::SharingMode::eExclusive, {},
                                        can.currentTransform, alpha_of(can), mode_, VK_TRUE,
                                        *chain_);
  chain_ = vk::raii::SwapchainKHR(device_->handle(), info);
  make_images();
  stale_ = false;
  return true;
}

void SwapChain::make_images() {
  for (const VkImage image : chain_.getImages()) {
    images_.emplace_back(image);
    views_.emplace_back(device_->handle(),
                        vk::ImageViewCreateInfo({}, image, vk::ImageViewType::e2D, format_, {},
                                                {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}));
    // One for each image: acquiring it again implies that its semaphore was waited for.
    drawn_.emplace_back(device_->handle(), vk::SemaphoreCreateInfo());
  }
}

std::optional<std::uint32_t> SwapChain::acquire(vk::Semaphore ready) {
  try {
    const auto [result, index] = chain_.acquireNextImage(kPatienceNanoseconds, ready);
    if (result == vk::Result::eTimeout || result == vk::Result::eNotReady) return std::nullopt;
    if (result == vk::Result::eSuboptimalKHR) stale_ = true;
    return index;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
    return std::nullopt;
  }
}

void SwapChain::present(std::uint32_t index) {
  const vk::Semaphore waited_for = drawn(index);
  const vk::SwapchainKHR chain = *chain_;
  try {
    const vk::Result result =
        device_->queue().presentKHR(vk::PresentInfoKHR(waited_for, chain, index));
    if (result == vk::Result::eSuboptimalKHR) stale_ = true;
  } catch (const vk::OutOfDateKHRError&) {
    stale_ = true;
  }
}

}  // namespace pillarfield::viewer::gpu
