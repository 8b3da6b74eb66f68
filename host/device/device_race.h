#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>

#include "pillarfield/processor.h"

namespace pillarfield {

/// Time that a device takes for a frame of a plan, s.
using FrameTime = std::function<double(const Device& device, const SolverPlan& plan)>;

/// Measures it with frames of a moving band of contact, a twelfth of the skin, two in flight.
/// Compiles the kernels first.
[[nodiscard]] double time_of_frame(const Device& device, const SolverPlan& plan);

/// The index of the device that solves a plan soonest. `file` remembers it for these devices and
/// kernels; what it does not know is measured and appended. A file that cannot be written is no
/// error. A device that fails loses.
[[nodiscard]] std::size_t soonest(std::span<const Device> devices, const SolverPlan& plan,
                                  const std::filesystem::path& file,
                                  const FrameTime& measure = time_of_frame);

}  // namespace pillarfield
