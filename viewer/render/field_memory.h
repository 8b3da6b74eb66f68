#pragma once

#include <cstdint>
#include <vector>

#include "viewer/gpu/buffer.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// Gives the graphics device access to fields: imports host memory where it can, else copies to a
/// device buffer.
class FieldMemory {
 public:
  explicit FieldMemory(const gpu::Device& device) : device_(&device) {}

  /// Returns a buffer with `field`; records the copy and its barrier where one is needed. Commands
  /// recorded earlier must be complete.
  [[nodiscard]] vk::Buffer take(const ShownField& field, const vk::raii::CommandBuffer& commands);

  /// Returns a buffer with the readings, always copied: they are few and rarely shown.
  [[nodiscard]] vk::Buffer take_readings(const FrameView& raw);

  /// Drops imported memory; call it before the source frees that memory.
  void forget() { imports_.clear(); }

  [[nodiscard]] std::uint64_t bytes_copied() const { return bytes_copied_; }
  [[nodiscard]] std::uint64_t fields_in_place() const { return fields_in_place_; }

 private:
  struct Import {
    std::span<const std::byte> pages;
    gpu::Buffer buffer;
  };

  [[nodiscard]] bool can_import(std::span<const std::byte> pages) const;
  [[nodiscard]] vk::Buffer import(std::span<const std::byte> pages);
  [[nodiscard]] vk::Buffer copy(std::span<const std::byte> pages,
                                const vk::raii::CommandBuffer& commands);

  const gpu::Device* device_;
  std::vector<Import> imports_;
  gpu::Buffer staging_;
  gpu::Buffer on_device_;
  gpu::Buffer readings_;
  std::uint64_t bytes_copied_ = 0;
  std::uint64_t fields_in_place_ = 0;
};

}  // namespace pillarfield::viewer
