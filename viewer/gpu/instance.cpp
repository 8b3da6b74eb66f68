#include "viewer/gpu/instance.h"

#include <algorithm>
#include <cstring>
#include <iostream>
#include <string_view>
#include <vector>

#include "pillarfield/error.h"

namespace pillarfield::viewer::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL take_message(VkDebugUtilsMessageSeverityFlagBitsEXT /*severity*/,
                                            VkDebugUtilsMessageTypeFlagsEXT /*types*/,
                                            const VkDebugUtilsMessengerCallbackDataEXT* data,
                                            void* count) {
  ++*static_cast<std::atomic<int>*>(count);
  std::cerr << "validation: " << data->pMessage << '\n';
  return VK_FALSE;
}

void require_layer(const vk::raii::Context& context) {
  const auto layers = context.enumerateInstanceLayerProperties();
  const bool found = std::any_of(layers.begin(), layers.end(), [](const auto& layer) {
    return std::string_view(layer.layerName) == kValidationLayer;
  });
  if (!found) {
    throw Error("Vulkan", "the validation layer was not found",
                "install vulkan-validationlayers, or omit --validate");
  }
}

void require_extensions(const vk::raii::Context& context, std::span<const char* const> wanted) {
  const auto present = context.enumerateInstanceExtensionProperties();
  for (const char* extension : wanted) {
    const bool found = std::any_of(present.begin(), present.end(), [&](const auto& candidate) {
      return std::strcmp(candidate.extensionName, extension) == 0;
    });
    if (!found) {
      throw Error("Vulkan", std::string("this computer's Vulkan has no ") + extension,
                  "render to a file instead: --headless");
    }
  }
}

}  // namespace

Instance::Instance(std::span<const char* const> extensions, bool validation)
    : context_(vkGetInstanceProcAddr) {
  if (context_.enumerateInstanceVersion() < VK_API_VERSION_1_2) {
    throw Error("Vulkan", "it is older than version 1.2", "update the graphics driver");
  }
  std::vector<const char*> enabled(extensions.begin(), extensions.end());
  std::vector<const char*> layers;
  if (validation) {
    require_layer(context_);
    layers.push_back(kValidationLayer);
    enabled.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    enabled.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
  }
  require_extensions(context_, extensions);

  const vk::ApplicationInfo application("pillarfield-viewer", 1, nullptr, 0, VK_API_VERSION_1_2);
  vk::InstanceCreateInfo info({}, &application, layers, enabled);
  const auto feature = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT features(1, &feature);
  if (validation) info.pNext = &features;
  try {
    instance_ = vk::raii::Instance(context_, info);
  } catch (const vk::IncompatibleDriverError&) {
    throw Error("Vulkan", "no driver was found",
                "install one, for instance mesa-vulkan-drivers, which needs no graphics card");
  }
  if (!validation) return;

  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  messenger_ = vk::raii::DebugUtilsMessengerEXT(
      instance_,
      vk::DebugUtilsMessengerCreateInfoEXT({}, Severity::eWarning | Severity::eError,
                                           Type::eGeneral | Type::eValidation | Type::ePerformance,
                                           take_message, messages_.get()));
}

}  // namespace pillarfield::viewer::gpu
