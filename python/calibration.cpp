#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <utility>

#include "pillarfield/calibration_file.h"
#include "python/arrays.h"
#include "python/bindings.h"
#include "python/pitch.h"

namespace pillarfield::python {
namespace {

constexpr const char* kCalibration =
    R"(The calibration of one skin: its planes and measured constants.

rows, cols: sensels
tare: reading of the unloaded sensel, counts
gain: factor on (raw - tare), 0.01..100
dead_zone: load below which a sensel reads zero, counts
mask: 0 dead or masked, 1 good, 2 absent
noise: standard deviation of the unloaded raw reading, counts
threshold_counts, counts_per_newton: constants, None where no step measured them

Planes are arrays [rows, cols], converted to float32 (mask: uint8) and copied; None: no correction.
Steps of pillarfield.calibrate return better ones. Raises Error for a plane of another size or a value
out of range.)";

using Plane = std::vector<float> Calibration::*;

SkinCalibration make_calibration(std::uint32_t rows, std::uint32_t cols, const py::object& tare,
                                 const py::object& gain, const py::object& dead_zone,
                                 const py::object& mask, const py::object& noise,
                                 std::optional<double> threshold_counts,
                                 std::optional<double> counts_per_newton,
                                 const py::kwargs& unknown) {
  refuse("Calibration", unknown,
         {"rows", "cols", "tare", "gain", "dead_zone", "mask", "noise", "threshold_counts",
          "counts_per_newton"});
  SkinCalibration made;
  made.rows = rows;
  made.cols = cols;
  const std::pair<Plane, const py::object*> planes[] = {{&Calibration::tare, &tare},
                                                        {&Calibration::gain, &gain},
                                                        {&Calibration::dead_zone, &dead_zone},
                                                        {&Calibration::noise, &noise}};
  for (const auto& [plane, given] : planes) {
    made.planes.*plane = plane_from<float>(*given, rows, cols, "Calibration");
  }
  made.planes.mask = plane_from<std::uint8_t>(mask, rows, cols, "Calibration");
  made.threshold_counts = threshold_counts;
  made.counts_per_newton = counts_per_newton;
  check(made, "Calibration");
  return made;
}

template <Plane plane>
py::object plane_of_calibration(const SkinCalibration& self) {
  return plane_or_none(self.planes.*plane, self.rows, self.cols);
}

SkinCalibration load_calibration(const std::filesystem::path& path, bool trust) {
  const py::gil_scoped_release unlocked;
  return read_calibration_file(path, {.trust = trust});
}

void save_calibration(const SkinCalibration& self, const std::filesystem::path& path,
                      bool overwrite) {
  const py::gil_scoped_release unlocked;
  write_calibration_file(path, self, overwrite ? Replace::anything : Replace::results);
}

py::list history_of(const SkinCalibration& self) {
  py::list steps;
  for (const CalibrationStep& step : self.history) {
    steps.append(fmt::format("{} {} of {} frames: {}", step.date_utc, step.step, step.frames,
                             step.parameters));
  }
  return steps;
}

std::string calibration_text(const SkinCalibration& self) {
  std::string planes;
  const auto add = [&](const char* name, bool is_set) {
    if (is_set) planes += fmt::format(", {}", name);
  };
  add("tare", !self.planes.tare.empty());
  add("gain", !self.planes.gain.empty());
  add("dead_zone", !self.planes.dead_zone.empty());
  add("mask", !self.planes.mask.empty());
  add("noise", !self.planes.noise.empty());
  add("effects", !self.planes.effects.empty());
  return fmt::format("<Calibration {} x {}{}>", self.rows, self.cols, planes);
}

}  // namespace

void bind_calibration(py::module_& module) {
  py::class_<SkinCalibration>(module, "Calibration", kCalibration)
      .def(py::init(&make_calibration), py::arg("rows"), py::arg("cols"), py::kw_only(),
           py::arg("tare") = py::none(), py::arg("gain") = py::none(),
           py::arg("dead_zone") = py::none(), py::arg("mask") = py::none(),
           py::arg("noise") = py::none(), py::arg("threshold_counts") = py::none(),
           py::arg("counts_per_newton") = py::none())
      .def_static("load", &load_calibration, py::arg("path"), py::kw_only(),
                  py::arg("trust") = false,
                  "Reads a calibration file. trust: it comes from your own programs.")
      .def("save", &save_calibration, py::arg("path"), py::kw_only(), py::arg("overwrite") = false,
           "Writes a calibration file. overwrite: replace an existing one.")
      .def_readonly("rows", &SkinCalibration::rows, "sensel rows")
      .def_readonly("cols", &SkinCalibration::cols, "sensel columns")
      .def_property_readonly("tare", &plane_of_calibration<&Calibration::tare>,
                             "float32 [rows, cols], counts, or None")
      .def_property_readonly("gain", &plane_of_calibration<&Calibration::gain>,
                             "float32 [rows, cols], or None")
      .def_property_readonly("dead_zone", &plane_of_calibration<&Calibration::dead_zone>,
                             "float32 [rows, cols], counts, or None")
      .def_property_readonly("noise", &plane_of_calibration<&Calibration::noise>,
                             "float32 [rows, cols], counts, or None")
      .def_property_readonly(
          "mask",
          [](const SkinCalibration& self) {
            return plane_or_none(self.planes.mask, self.rows, self.cols);
          },
          "uint8 [rows, cols], or None")
      .def_readonly("threshold_counts", &SkinCalibration::threshold_counts, "counts, or None")
      .def_readonly("counts_per_newton", &SkinCalibration::counts_per_newton, "counts/N, or None")
      .def_readonly("sensel_pitch_mm", &SkinCalibration::sensel_pitch_mm, "mm, or None")
      .def_property_readonly(
          "layout",
          [](const SkinCalibration& self) {
            return self.layout ? std::optional<std::string>(name_of(*self.layout)) : std::nullopt;
          },
          "'pillars', 'sensels', or None")
      .def_property_readonly(
          "effects", [](const SkinCalibration& self) { return names_of(self.planes.effects); },
          "names of the corrections that all sensels share")
      .def_property_readonly("history", &history_of, "one line a step, oldest first")
      .def("__repr__", &calibration_text);
}

}  // namespace pillarfield::python
