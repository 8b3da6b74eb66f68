#pragma once

#include "viewer/gpu/device.h"

namespace pillarfield::viewer::gpu {

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
