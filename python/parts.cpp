#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "pillarfield/solve_range.h"
#include "python/bindings.h"
#include "python/frames.h"
#include "python/process.h"
#include "python/signals.h"

namespace pillarfield::python {
namespace {

/// Solves a part; returns whether it was not whole before.
bool solve_part_of(Frames& frames, const SolverPlan& plan, const std::string& source_name,
                   const std::filesystem::path& output, std::uint64_t index, std::uint64_t count,
                   std::uint64_t checkpoint_every, std::uint64_t warm_up, bool contacts,
                   const std::string& device_name) {
  const py::gil_scoped_release unlocked;
  const std::lock_guard alone(frames.alone);
  RangeOptions options;
  options.checkpoints = {checkpoint_every, warm_up};
  if (contacts) set_sensor(options.contacts.emplace(), plan);
  SignalCheck check_signals;
  options.stop = [&] { return check_signals(), false; };
  const Device device = device_named(device_name);
  ForcePart part;
  part.index = index;
  part.count = count;
  return solve_part(*frames.source, device, plan, options, output,
                    file_info(plan, device, source_name), part)
      .has_value();
}

void join(const std::filesystem::path& output, bool overwrite, bool trust) {
  const py::gil_scoped_release unlocked;
  SignalCheck check_signals;
  join_parts(output, {.replace = overwrite ? Replace::anything : Replace::results,
                      .read = {.trust = trust},
                      .progress = [&](auto...) { check_signals(); }});
}

}  // namespace

void bind_parts(py::module_& module) {
  module.def("solve_part", &solve_part_of, py::arg("source"), py::arg("plan"),
             py::arg("source_name"), py::arg("output"), py::arg("index"), py::arg("count"),
             py::arg("checkpoint_every"), py::arg("warm_up"), py::arg("contacts"),
             py::arg("device"), "Solves a part; whether it was not whole before.");
  module.def("join_parts", &join, py::arg("output"), py::arg("overwrite"), py::arg("trust"),
             "Joins parts.");
  module.def(
      "most_parts",
      [](std::uint64_t frames, std::uint64_t every) {
        return most_parts(frames, {every, 0});
      },
      py::arg("frames"), py::arg("checkpoint_every"), "The largest useful number of parts.");
}

}  // namespace pillarfield::python
