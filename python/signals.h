#pragma once

#include <chrono>

#include "python/arrays.h"

namespace pillarfield::python {

/// Lets Python handle signals such as Ctrl+C during long calls, which run without its lock: throws
/// what the handler raises. Looks five times a second.
class SignalCheck {
 public:
  void operator()() {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return;
    next_ = now + std::chrono::milliseconds(200);
    const py::gil_scoped_acquire locked;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  }

 private:
  std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now();
};

}  // namespace pillarfield::python
