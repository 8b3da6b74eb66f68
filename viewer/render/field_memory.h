#pragma once

#include <cstdint>
#include <vector>

#include "viewer/gpu/buffer.h"
#include "viewer/source/shown_field.h"

namespace pillarfield::viewer {

/// Fields where the graphics device reads them: in place, where it can import the host's memory,
/// and copied to a buffer of the device elsewhere.
class FieldMemory {
 public:
  explicit FieldMemory(const gpu::Device& device) : device_(&device) {}

  /// Makes `field` readable; where it must be copied, the copy and its barrier are recorded. The
  /// commands that were recorded the last time must be done.
  [[nodiscard]] vk::Buffer take(const ShownField& field, const vk::raii::CommandBuffer& commands);

  /// The same for readings, always by a copy: they are few, and rarely looked at.
  [[nodiscard]] vk::Buffer take_readings(const FrameView& raw);

  /// What is read in place belongs to a source: forget it before its memory goes.
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
