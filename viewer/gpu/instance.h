#pragma once

#include <atomic>
#include <span>
#include <string>

#include "viewer/gpu/vulkan.h"

namespace pillarfield::viewer::gpu {

/// Vulkan loader, instance, and messages of the validation layer.
class Instance {
 public:
  /// `extensions` are those of the window, if any. `validation` enables the validation layer with
  /// synchronisation checks; its messages go to standard error and are counted. Throws Error where
  /// Vulkan, the layer or an extension is missing.
  Instance(std::span<const char* const> extensions, bool validation);

  [[nodiscard]] const vk::raii::Instance& handle() const { return instance_; }

  /// Number of warnings and errors of the validation layer.
  [[nodiscard]] int validation_messages() const { return *messages_; }

 private:
  vk::raii::Context context_;
  vk::raii::Instance instance_ = nullptr;
  std::unique_ptr<std::atomic<int>> messages_ = std::make_unique<std::atomic<int>>(0);
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
};

}  // namespace pillarfield::viewer::gpu
