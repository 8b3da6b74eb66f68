#include <pybind11/stl.h>

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "calibration/steps.h"
#include "pillarfield/error.h"
#include "python/bindings.h"
#include "python/frames.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

/// References, since Python's None is a null pointer.
using SomeFrames = std::vector<std::reference_wrapper<Frames>>;

StepFrames step_frames(Frames& frames) {
  const FrameSource& source = *frames.source;
  const auto for_each = [&frames](const StepFrames::Use& use) {
    const std::lock_guard alone(frames.alone);
    FrameSource& from = *frames.source;
    FrameBuffer frame(from.sensel_type(), from.skin().rows, from.skin().cols);
    SignalCheck check_signals;
    for (std::uint64_t i = 0; i < from.frames(); ++i) {
      check_signals();
      const double time_s = from.read(i, frame);
      use(frame.view(), time_s);
    }
  };
  return {.file = "",
          .skin = source.skin(),
          .sensel_type = source.sensel_type(),
          .mask = source.calibration().mask,
          .frames = source.frames(),
          .for_each = for_each};
}

/// The pressures of all frames of each source.
std::vector<PressureLog> logs_of(const SomeFrames& sources,
                                 const std::vector<std::vector<double>>& pressures_kpa) {
  // Its holder may wait for Python's lock.
  const py::gil_scoped_release unlocked;
  std::vector<PressureLog> logs;
  for (std::size_t i = 0; i < std::min(sources.size(), pressures_kpa.size()); ++i) {
    Frames& frames = sources[i];
    const std::lock_guard alone(frames.alone);
    std::vector<double> times_s(frames.source->frames());
    for (std::size_t t = 0; t < times_s.size(); ++t) times_s[t] = frames.source->time(t);
    logs.emplace_back("frames", times_s, pressures_kpa[i]);
  }
  return logs;
}

/// Words, numbers, lists of numbers, and the pressures of frames; None is not given.
StepValues values_of(const SomeFrames& sources, const py::dict& given) {
  StepValues values;
  for (const auto& [key, value] : given) {
    const auto name = key.cast<std::string>();
    if (value.is_none()) continue;
    if (py::isinstance<py::str>(value)) {
      values.words[name] = argument<std::string>(value, name);
    } else if (name == "pressure") {
      values.logs = logs_of(sources, argument<std::vector<std::vector<double>>>(value, name));
    } else if (py::isinstance<py::sequence>(value)) {
      values.numbers[name] = argument<std::vector<double>>(value, name);
    } else {
      values.numbers[name] = {argument<double>(value, name)};
    }
  }
  return values;
}

const StepKind& step_named(const std::string& name) {
  for (const StepKind& step : calibration_steps()) {
    if (name == step.name) return step;
  }
  throw Error("calibrate", "'" + name + "' is not a step", "see pillarfield.calibrate");
}

/// The better calibration, the facts as JSON, and warnings.
std::tuple<SkinCalibration, std::string, std::vector<std::string>> run_named(
    const std::string& name, const SomeFrames& sources,
    const std::optional<SkinCalibration>& before, const py::dict& given) {
  StepValues values = values_of(sources, given);
  std::vector<StepFrames> files;
  for (Frames& frames : sources) files.push_back(step_frames(frames));
  const py::gil_scoped_release unlocked;
  StepResult done = run_step(step_named(name), std::move(files), before, std::move(values));
  return {std::move(done.calibration), done.report.facts.dump(), std::move(done.report.warnings)};
}

}  // namespace

void bind_calibrate(py::module_& module) {
  module.def("calibrate", &run_named, py::arg("step"), py::arg("frames"), py::arg("before"),
             py::arg("values"),
             "A step of pillarfield.calibrate: the better calibration, facts as JSON, warnings.");
}

}  // namespace pillarfield::python
