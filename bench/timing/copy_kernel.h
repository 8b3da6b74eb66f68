#pragma once

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "bench/frames.h"
#include "bench/timing/copy_source.h"
#include "pillarfield/processor.h"

namespace pillarfield::bench {

/// An OpenCL device of the library, opened once more.
struct OpenedDevice {
  explicit OpenedDevice(const Device& opened);
  [[nodiscard]] cl::Program program(const std::string& source) const;

  cl::Device device;
  cl::Context context;
};

/// Frees what std::aligned_alloc() gave.
struct FreePages {
  // NOLINTNEXTLINE(cppcoreguidelines-no-malloc): RAII is the unique_ptr that has this deleter
  void operator()(std::byte* memory) const { std::free(memory); }
};

/// The copy bandwidth limit of a plan's solve: a kernel of the solve's launch geometry that reads
/// and writes the bytes of the solve and computes nothing. It reads the frames in place where the
/// device shares the host's memory; elsewhere they are on the device beforehand, and no transfer is
/// timed.
///
/// Each of the `frames_in_flight` slots has its own queue and results. `frames` must outlive it.
class CopyKernel {
 public:
  CopyKernel(const Device& device, const SolverPlan& plan, const Frames& frames,
             const CopyKind& kind, int frames_in_flight);

  /// Copies the next `frames` frames.
  void run(int frames);

  /// Output of the last frame: the result planes one after the other, then the status bytes.
  [[nodiscard]] std::vector<std::byte> results() const;

  [[nodiscard]] const OpenedDevice& device() const { return device_; }
  // Inputs of the kernel.
  [[nodiscard]] const cl::Buffer& frame(std::size_t index) const { return frames_.at(index); }
  [[nodiscard]] const cl::Buffer& calibration() const { return calibration_.buffer; }
  [[nodiscard]] const cl::Buffer& mask() const { return mask_.buffer; }

 private:
  /// A buffer in large pages, as in the solver.
  struct Planes {
    std::unique_ptr<std::byte[], FreePages>
        pages;  ///< null where the device does not share the host's memory
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

  OpenedDevice device_;
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

/// Launches a kernel that does nothing, and waits for it.
class EmptyLaunch {
 public:
  explicit EmptyLaunch(const Device& device);
  void run(int launches);

 private:
  explicit EmptyLaunch(const OpenedDevice& opened);

  cl::CommandQueue queue_;
  cl::Kernel kernel_;
};

}  // namespace pillarfield::bench
