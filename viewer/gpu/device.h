#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "viewer/gpu/instance.h"

namespace pillarfield::viewer::gpu {

struct DeviceOptions {
  std::string name;           ///< a part of the device's name, any case; empty: the best one
  VkSurfaceKHR surface = {};  ///< it must be able to present to; null without a window
  bool import_memory = true;  ///< false: pretends that the host's memory cannot be imported
};

/// A graphics device with the one queue that everything goes through.
class Device {
 public:
  /// Throws Error that lists the devices and why each was passed over.
  Device(const Instance& instance, const DeviceOptions& options);

  [[nodiscard]] const vk::raii::Device& handle() const { return device_; }
  [[nodiscard]] const vk::raii::PhysicalDevice& physical() const { return physical_; }
  [[nodiscard]] const vk::raii::Queue& queue() const { return queue_; }
  [[nodiscard]] std::uint32_t queue_family() const { return queue_family_; }
  [[nodiscard]] const std::string& name() const { return name_; }

  /// Whether memory of the host can be read in place (VK_EXT_external_memory_host), and at which
  /// alignment of address and size.
  [[nodiscard]] bool imports_memory() const { return import_alignment_ != 0; }
  [[nodiscard]] std::size_t import_alignment() const { return import_alignment_; }

  /// Index of a memory type among `allowed` (bits) with all of `needed`, if possible with `wished`
  /// too. Throws Error where there is none.
  [[nodiscard]] std::uint32_t memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags needed,
                                          vk::MemoryPropertyFlags wished = {}) const;

  /// Records commands, submits them and waits until they are done.
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

}  // namespace pillarfield::viewer::gpu
