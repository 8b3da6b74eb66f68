#pragma once

#include <cstddef>
#include <memory>

#include "base/large_pages.h"
#include "device/opencl.h"

namespace pillarfield {

/// Pinned host memory: the driver copies from and to it directly.
class PinnedMemory {
 public:
  PinnedMemory(const cl::Context& context, const cl::CommandQueue& queue, std::size_t bytes)
      : queue_(queue),
        buffer_(context, CL_MEM_ALLOC_HOST_PTR, bytes),
        mapped_(queue.enqueueMapBuffer(buffer_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, bytes)),
        bytes_(bytes) {}
  ~PinnedMemory() {
    try {
      queue_.enqueueUnmapMemObject(buffer_, mapped_);
      queue_.finish();
    } catch (const cl::Error&) {
      // The device and its memory are gone.
    }
  }
  PinnedMemory(const PinnedMemory&) = delete;
  PinnedMemory& operator=(const PinnedMemory&) = delete;

  [[nodiscard]] std::byte* data() const { return static_cast<std::byte*>(mapped_); }

  /// Its first page boundary.
  [[nodiscard]] std::byte* first_page() const {
    void* place = mapped_;
    std::size_t space = bytes_;
    return static_cast<std::byte*>(std::align(kPageSize, 1, place, space));
  }

 private:
  cl::CommandQueue queue_;
  cl::Buffer buffer_;
  void* mapped_;
  std::size_t bytes_;
};

}  // namespace pillarfield
