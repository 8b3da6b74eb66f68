#include "pillarfield/doctor.h"

#include <limits>
#include <mutex>
#include <string>

#include "calibration/doctor/diagnosis_facts.h"
#include "python/bindings.h"
#include "python/frames.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

/// The facts as JSON.
std::string diagnose(Frames& frames, const std::string& name, bool timed) {
  Diagnosis found;
  {
    const py::gil_scoped_release unlocked;
    const std::lock_guard alone(frames.alone);
    FrameSource& source = *frames.source;
    Doctor doctor(name, source.skin(), source.sensel_type());
    FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
    SignalCheck check_signals;
    for (std::uint64_t i = 0; i < source.frames(); ++i) {
      check_signals();
      const double time_s = source.read(i, frame);
      doctor.add(frame.view(), timed ? time_s : std::numeric_limits<double>::quiet_NaN());
    }
    found = doctor.result();
  }
  return facts_of(found).dump();
}

}  // namespace

void bind_doctor(py::module_& module) {
  module.def("doctor", &diagnose, py::arg("frames"), py::arg("name"), py::arg("timed"),
             "The facts of pillarfield.doctor() as JSON.");
}

}  // namespace pillarfield::python
