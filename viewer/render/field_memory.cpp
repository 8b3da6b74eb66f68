#include "viewer/render/field_memory.h"

#include <algorithm>
#include <cstring>

#include "viewer/gpu/device.h"

namespace pillarfield::viewer {
namespace {

using Usage = vk::BufferUsageFlagBits;
using Place = gpu::Buffer::Place;

}  // namespace

vk::Buffer FieldMemory::take(const ShownField& field, const vk::raii::CommandBuffer& commands) {
  return can_import(field.pages) ? import(field.pages) : copy(field.pages, commands);
}

bool FieldMemory::can_import(std::span<const std::byte> pages) const {
  if (!device_->imports_memory()) return false;
  const std::size_t alignment = device_->import_alignment();
  const auto address = reinterpret_cast<std::uintptr_t>(pages.data());
  return address % alignment == 0 && pages.size() % alignment == 0;
}

vk::Buffer FieldMemory::import(std::span<const std::byte> pages) {
  ++fields_in_place_;
  const auto known = std::find_if(imports_.begin(), imports_.end(), [&](const Import& import) {
    return import.pages.data() == pages.data() && import.pages.size() == pages.size();
  });
  if (known != imports_.end()) return known->buffer.handle();
  imports_.push_back({pages, gpu::Buffer(*device_, pages, Usage::eStorageBuffer)});
  return imports_.back().buffer.handle();
}

vk::Buffer FieldMemory::copy(std::span<const std::byte> pages,
                             const vk::raii::CommandBuffer& commands) {
  if (staging_.size() < pages.size()) {
    staging_ = gpu::Buffer(*device_, pages.size(), Usage::eTransferSrc, Place::host);
    on_device_ = gpu::Buffer(*device_, pages.size(), Usage::eTransferDst | Usage::eStorageBuffer,
                             Place::device);
  }
  std::memcpy(staging_.data(), pages.data(), pages.size());
  commands.copyBuffer(staging_.handle(), on_device_.handle(), vk::BufferCopy(0, 0, pages.size()));
  using Stage = vk::PipelineStageFlagBits;
  gpu::barrier(commands, {Stage::eTransfer, vk::AccessFlagBits::eTransferWrite},
               {Stage::eComputeShader | Stage::eVertexShader | Stage::eFragmentShader,
                vk::AccessFlagBits::eShaderRead});
  bytes_copied_ += pages.size();
  return on_device_.handle();
}

vk::Buffer FieldMemory::take_readings(const FrameView& raw) {
  const std::size_t bytes =
      raw.data == nullptr ? 0 : ((raw.rows - 1) * raw.row_stride + raw.cols) * size_of(raw.type);
  if (readings_.size() < std::max<std::size_t>(bytes, 4)) {
    const std::size_t whole_words = (std::max<std::size_t>(bytes, 4) + 3) / 4 * 4;
    readings_ = gpu::Buffer(*device_, whole_words, Usage::eStorageBuffer, Place::host);
  }
  if (bytes != 0) std::memcpy(readings_.data(), raw.data, bytes);
  return readings_.handle();
}

}  // namespace pillarfield::viewer
