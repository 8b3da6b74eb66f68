#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/thread_pool.h"
#include "device/device_state.h"
#include "device/opencl.h"
#include "device/pinned_memory.h"
#include "lanes/frame_memory.h"

namespace pillarfield {

/// The text of kernels/frame/pack_results.cl.
std::string_view pack_program();

/// Brings the results of a slot from a device with its own memory into `pages` of the host: the
/// groups of 64 pillars that changed, in one read of as many as the frame before had and a quarter
/// more; all planes where that frame had more than a quarter of them.
class PackedResults {
 public:
  /// Sets `pages` to zero; they, `results` and `pool` must outlive it.
  PackedResults(Device::State& device, const cl::CommandQueue& queue, const ResultLayout& layout,
                cl::Buffer results, std::byte* pages, ThreadPool& pool);

  /// Starts the transfer, behind the solve.
  void download(const cl::CommandQueue& queue);
  /// After the commands of download(): starts to read groups beyond those expected; false if there
  /// are none.
  [[nodiscard]] bool fetch_rest(const cl::CommandQueue& queue);
  /// After all commands: copies the groups into their planes, once a frame.
  void unpack();

  /// The groups without a touched pillar, after unpack().
  [[nodiscard]] IdleBlocks idle() const;

 private:
  void take(std::size_t place);
  void mark(std::size_t group);

  ResultLayout layout_;
  std::size_t planes_;
  std::size_t pillars_;
  std::size_t groups_;
  std::size_t group_bytes_;
  std::byte* pages_;
  ThreadPool& pool_;
  cl::Buffer results_;
  cl::Buffer sent_;  ///< the results that the host has
  cl::Buffer packed_;
  PinnedMemory packed_on_host_;
  cl::Kernel kernel_;
  std::vector<std::uint8_t> idle_;  ///< as IdleBlocks::flags
  std::size_t stride_;
  std::size_t count_ = 0;     ///< groups of the last frame
  std::size_t expected_ = 0;  ///< groups read
  bool takes_planes_ = false;
  bool is_pending_ = false;
};

}  // namespace pillarfield
