#pragma once

#include <atomic>
#include <span>
#include <string>

#include "viewer/gpu/vulkan.h"

namespace pillarfield::viewer::gpu {

/// The door to Vulkan: loader, instance, and the messages of the validation layer.
class Instance {
 public:
  /// `extensions`: those that a window needs; none without a window. With `validation` the
  /// validation layer and its checks of synchronisation watch every call; their messages go to
  /// standard error and are counted. Throws Error where Vulkan, the layer or an extension is
  /// missing.
  Instance(std::span<const char* const> extensions, bool validation);

  [[nodiscard]] const vk::raii::Instance& handle() const { return instance_; }

  /// Warnings and errors of the validation layer so far.
  [[nodiscard]] int validation_messages() const { return *messages_; }

 private:
  vk::raii::Context context_;
  vk::raii::Instance instance_ = nullptr;
  std::unique_ptr<std::atomic<int>> messages_ = std::make_unique<std::atomic<int>>(0);
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
};

}  // namespace pillarfield::viewer::gpu
