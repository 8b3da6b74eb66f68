#pragma once

#include <string>

#include "pillarfield/processor.h"

namespace pillarfield::python {

/// The device of this name, opened once a process. Throws Error in a process that was forked after
/// a device was opened: its threads did not come along.
[[nodiscard]] Device device_named(const std::string& name);

/// Throws Error in a forked process that must not use the device.
void require_opencl_process();

/// Whether this process is a fork of the one that opened a device. What belongs to the device is
/// then left alone, also at its end.
[[nodiscard]] bool is_forked();

}  // namespace pillarfield::python
