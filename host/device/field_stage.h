#pragma once

#include <vector>

#include "core/field_work.h"
#include "device/device_state.h"
#include "device/slot_memory.h"

namespace pillarfield {

/// The field estimator on a device: goes over a frame that the direct solve left, contact by
/// contact. One for all slots of a processor, whose frames come one after the other.
class FieldStage {
 public:
  /// `groups`: contacts are shared by work-groups of many work-items, as suits a GPU; else each is
  /// one work-item's. Throws Error on a device without double precision.
  FieldStage(Device::State& device, const SolverPlan& plan, bool groups);

  /// Resolves the open pillars of a frame whose planes lie in `memory`, and waits.
  void resolve(const cl::CommandQueue& queue, SlotMemory& memory);

 private:
  /// A buffer that grows with what it has to hold.
  class Growing {
   public:
    const cl::Buffer& of(const cl::Context& context, std::size_t bytes);

   private:
    cl::Buffer buffer_;
    std::size_t bytes_ = 0;
  };

  cl_uint set_field(cl::Kernel& kernel, const SlotMemory& memory) const;
  void enqueue_contacts(const cl::CommandQueue& queue, const SlotMemory& memory);
  void enqueue_pillars(const cl::CommandQueue& queue, const SlotMemory& memory);
  void keep_for_next(const cl::CommandQueue& queue, const SlotMemory& memory);
  const cl::Buffer& send_runs(const cl::CommandQueue& queue);

  cl::Context context_;
  std::uint32_t rows_;
  std::uint32_t cols_;
  FieldWork work_;
  std::size_t group_ = 1;    ///< work-items of a contact
  std::size_t workers_ = 1;  ///< work-items for pillars alone
  cl::Kernel contacts_;
  cl::Kernel pillars_;
  cl::Kernel keep_;
  cl::Buffer past_normal_;  ///< null where frames are not close in time
  cl::Buffer past_deviation_;
  cl::Buffer past_frame_;
  cl_uint now_ = 1;  ///< frames that were seen, and one: pillars begin with frame 0
  Growing tiles_;
  Growing runs_;
  Growing verdicts_;
  Growing kinds_;
  Growing planes_;
  Growing lines_;
  Growing shared_;
  Growing counts_;
  Growing alone_;
};

/// The OpenCL C of the field estimator, complete; `groups` as above.
[[nodiscard]] std::string field_kernel_source(bool groups);

}  // namespace pillarfield
