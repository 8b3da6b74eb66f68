#include "viewer/gpu/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield::viewer::gpu {
namespace {

bool has_extension(const vk::raii::PhysicalDevice& device, std::string_view name) {
  const auto extensions = device.enumerateDeviceExtensionProperties();
  return std::any_of(extensions.begin(), extensions.end(), [&](const auto& extension) {
    return std::string_view(extension.extensionName) == name;
  });
}

/// A queue family with graphics, compute and, given a surface, presentation.
std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& device,
                                               VkSurfaceKHR surface) {
  const auto families = device.getQueueFamilyProperties();
  const auto needed = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
  for (std::uint32_t index = 0; index < families.size(); ++index) {
    if ((families[index].queueFlags & needed) != needed) continue;
    if (surface == nullptr || device.getSurfaceSupportKHR(index, surface) != 0) return index;
  }
  return std::nullopt;
}

/// Reason for rejecting a device; empty for none.
std::string unsuitable(const vk::raii::PhysicalDevice& device, VkSurfaceKHR surface) {
  if (device.getProperties().apiVersion < VK_API_VERSION_1_2) return "older than Vulkan 1.2";
  if (surface != nullptr && !has_extension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME)) {
    return "cannot show a window";
  }
  if (!find_queue_family(device, surface)) {
    return surface == nullptr ? "has no queue that draws and computes"
                              : "has no queue that draws, computes and shows this window";
  }
  return {};
}

int rank(vk::PhysicalDeviceType type) {
  switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
      return 3;
    case vk::PhysicalDeviceType::eIntegratedGpu:
      return 2;
    case vk::PhysicalDeviceType::eVirtualGpu:
      return 1;
    default:
      return 0;
  }
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  return text;
}

std::string name_of(const vk::raii::PhysicalDevice& device) {
  return device.getProperties().deviceName.data();
}

vk::raii::PhysicalDevice choose(const Instance& instance, const DeviceOptions& options) {
  std::vector<vk::raii::PhysicalDevice> devices;
  try {
    devices = vk::raii::PhysicalDevices(instance.handle());
  } catch (const vk::SystemError&) {
    // Reported below as an empty list.
  }
  const vk::raii::PhysicalDevice* best = nullptr;
  std::string rejected;
  for (const auto& device : devices) {
    std::string reason = unsuitable(device, options.surface);
    if (reason.empty() && lower(name_of(device)).find(lower(options.name)) == std::string::npos) {
      reason = "has another name";
    }
    if (!reason.empty()) {
      rejected += fmt::format("; {}: {}", name_of(device), reason);
    } else if (best == nullptr ||
               rank(device.getProperties().deviceType) > rank(best->getProperties().deviceType)) {
      best = &device;
    }
  }
  if (best == nullptr) {
    throw Error("Vulkan", fmt::format("no suitable device was found{}", rejected),
                "install a driver, for instance mesa-vulkan-drivers");
  }
  return *best;
}

std::size_t find_import_alignment(const vk::raii::PhysicalDevice& device) {
  if (!has_extension(device, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME)) return 0;
  const auto properties =
      device.getProperties2<vk::PhysicalDeviceProperties2,
                            vk::PhysicalDeviceExternalMemoryHostPropertiesEXT>();
  return properties.get<vk::PhysicalDeviceExternalMemoryHostPropertiesEXT>()
      .minImportedHostPointerAlignment;
}

}  // namespace

Device::Device(const Instance& instance, const DeviceOptions& options)
    : physical_(choose(instance, options)),
      name_(name_of(physical_)),
      queue_family_(find_queue_family(physical_, options.surface).value()),
      import_alignment_(options.import_memory ? find_import_alignment(physical_) : 0) {
  std::vector<const char*> extensions;
  if (options.surface != nullptr) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
  if (imports_memory()) extensions.push_back(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);

  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue({}, queue_family_, 1, &priority);
  device_ = vk::raii::Device(physical_, vk::DeviceCreateInfo({}, queue, {}, extensions));
  queue_ = vk::raii::Queue(device_, queue_family_, 0);
  pool_ =
      vk::raii::CommandPool(device_, {vk::CommandPoolCreateFlagBits::eTransient, queue_family_});
}

std::uint32_t Device::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags needed,
                                  vk::MemoryPropertyFlags preferred) const {
  const auto properties = physical_.getMemoryProperties();
  for (const auto flags : {needed | preferred, needed}) {
    for (std::uint32_t index = 0; index < properties.memoryTypeCount; ++index) {
      const bool is_allowed = (allowed >> index & 1u) != 0;
      if (is_allowed && (properties.memoryTypes.at(index).propertyFlags & flags) == flags) {
        return index;
      }
    }
  }
  throw Error(name_, "it lacks a required memory type", "choose another device: --gpu NAME");
}

void Device::run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const {
  const vk::raii::CommandBuffers buffers(
      device_, vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1));
  const vk::raii::CommandBuffer& commands = buffers.front();
  commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  commands.end();
  const vk::raii::Fence done(device_, vk::FenceCreateInfo());
  queue_.submit(vk::SubmitInfo({}, {}, *commands, {}), *done);
  static_cast<void>(device_.waitForFences(*done, VK_TRUE, UINT64_MAX));
}

}  // namespace pillarfield::viewer::gpu
