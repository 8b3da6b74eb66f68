#pragma once

#include <memory>
#include <string>

#include "device/device_state.h"
#include "device/slot_memory.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/processor.h"

namespace pillarfield {

/// The field estimator: goes over a frame that the direct solve left, contact by contact. One for
/// all slots of a processor, whose frames come one after the other.
class FieldStage {
 public:
  virtual ~FieldStage() = default;

  /// Lets drivers finish compiling, which the first frame shall not wait for; `memory` holds a
  /// frame of silence, and still does.
  virtual void warm_up(const cl::CommandQueue& queue, SlotMemory& memory) = 0;

  /// Resolves the open pillars of a frame whose planes lie in `memory`, and waits.
  virtual void resolve(const cl::CommandQueue& queue, SlotMemory& memory) = 0;

  /// The contacts of that frame.
  [[nodiscard]] virtual const ContactMap& contacts() const = 0;
};

/// Whether contacts are shared by work-groups of many work-items; else each is one work-item's.
[[nodiscard]] bool shares_by_groups(const DeviceInfo& device, ContactSharing sharing);

/// By kernels; throws Error on a device without double precision. `groups` as above.
std::unique_ptr<FieldStage> device_field_stage(Device::State& device, const SolverPlan& plan,
                                               bool groups);

/// By the host, in place, where the device shares its memory and is made of the same cores: the
/// same mathematics as C++, without a launch. As many threads as the device has compute units share
/// the contacts.
std::unique_ptr<FieldStage> host_field_stage(const Device::State& device, const SolverPlan& plan);

/// The contact estimator, by the host on the host's side of the planes, which is where its results
/// are wanted: the same bits whatever the device.
std::unique_ptr<FieldStage> contact_stage(const Device::State& device, const SolverPlan& plan);

/// The OpenCL C of the field estimator, complete; `groups` as above.
[[nodiscard]] std::string field_kernel_source(bool groups);

}  // namespace pillarfield
