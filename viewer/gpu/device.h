#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "viewer/gpu/instance.h"

namespace pillarfield::viewer::gpu {

struct DeviceOptions {
  std::string name;           ///< part of the device's name, any case; empty: the best device
  VkSurfaceKHR surface = {};  ///< surface to present to; null without a window
  bool import_memory = true;  ///< false: never import host memory
};

/// A graphics device with one queue.
class Device {
 public:
  /// Throws Error with the devices and the reason for rejecting each.
  Device(const Instance& instance, const DeviceOptions& options);

  [[nodiscard]] const vk::raii::Device& handle() const { return device_; }
  [[nodiscard]] const vk::raii::PhysicalDevice& physical() const { return physical_; }
  [[nodiscard]] const vk::raii::Queue& queue() const { return queue_; }
  [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Host memory can be imported (VK_EXT_external_memory_host), at import_alignment().
  [[nodiscard]] bool imports_memory() const { return import_alignment_ != 0; }
  [[nodiscard]] std::size_t import_alignment() const { return import_alignment_; }

  /// Index of a memory type among `allowed` (bits) with all `needed` properties and, if possible,
  /// the `preferred` ones. Throws Error for none.
  [[nodiscard]] std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags needed,
                                          vk::MemoryPropertyFlags preferred = {}) const;

  /// Records commands, submits them and waits for completion.
  void run(const std::function<void(const vk::raii::CommandBuffer&)>& record) const;

 private:
  vk::raii::PhysicalDevice physical_ = nullptr;
  std::string name_;
  std::uint32_t queue_family_ = 0;
  std::size_t import_alignment_ = 0;
  vk::raii::Device device_ = nullptr;
  vk::raii::Queue queue_ = nullptr;
  vk::raii::CommandPool pool_ = nullptr;
};

/// A global memory barrier between the accesses `from` and `to`.
struct Access {
  vk::PipelineStageFlags stages;
  vk::AccessFlags accesses;
};
inline void barrier(const vk::raii::CommandBuffer& commands, const Access& from, const Access& to) {
  const vk::MemoryBarrier memory(from.accesses, to.accesses);
  commands.pipelineBarrier(from.stages, to.stages, {}, memory, nullptr, nullptr);
}

}  // namespace pillarfield::viewer::gpu
