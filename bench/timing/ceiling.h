#pragma once

#include <vector>

#include "bench/frames.h"
#include "bench/timing/copy_source.h"
#include "device/device_state.h"
#include "device/large_pages.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// What no solve can be faster than: a kernel that reads and writes what the solve of a plan does,
/// launched like it, and computes nothing. Where the device shares the host's memory it reads the
/// frames in place; elsewhere they are on the device from the start, and no transfer is timed.
///
/// As many frames are in flight as the solver has, each with a queue and results of its own.
/// `frames` must outlive it.
class CopyKernel {
 public:
  CopyKernel(const Device& device, const SolverPlan& plan, const Frames& frames,
             const CopyKind& kind, int frames_in_flight);

  /// Copies so many frames.
  void run(int frames);

  /// What the last frame became: the result planes one after the other, then the status bytes.
  [[nodiscard]] std::vector<std::byte> results() const;

  /// What the kernel reads.
  [[nodiscard]] const cl::Buffer& frame(std::size_t index) const { return frames_.at(index); }
  [[nodiscard]] const cl::Buffer& calibration() const { return calibration_.buffer; }
  [[nodiscard]] const cl::Buffer& mask() const { return mask_.buffer; }

 private:
  /// Memory in pages as the solver has them, which outlives the buffer on it.
  struct Planes {
    LargePages pages;  ///< null where the device does not share the host's memory
    cl::Buffer buffer;
  };
  struct Slot {
    cl::CommandQueue queue;
    cl::Kernel kernel;
    Planes results;
    Planes status;
  };
  [[nodiscard]] Planes make_planes(std::size_t bytes) const;
  template <class Value>
  [[nodiscard]] Planes numbered(std::size_t count) const;
  [[nodiscard]] Slot make_slot(const cl::Program& program) const;
  void start(Slot& slot);

  cl::Context context_;
  cl::Device device_;
  Skin skin_;
  Streams streams_;
  std::vector<cl::Buffer> frames_;
  bool shared_;
  Planes calibration_;
  Planes mask_;
  cl::NDRange global_;
  cl::NDRange local_;
  std::vector<Slot> slots_;
  std::size_t started_ = 0;
};

/// What a launch costs: a kernel that does nothing, started and waited for.
class EmptyLaunch {
 public:
  explicit EmptyLaunch(const Device& device);
  void run(int launches);

 private:
  cl::CommandQueue queue_;
  cl::Kernel kernel_;
};

}  // namespace pillarfield::bench
