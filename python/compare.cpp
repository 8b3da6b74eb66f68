#include <pybind11/stl.h>

#include "pillarfield/comparison.h"
#include "pillarfield/error.h"
#include "python/bindings.h"
#include "python/force_planes.h"

namespace pillarfield::python {
namespace {

std::vector<RegionErrors> compare(const py::dict& solved_planes, const py::dict& true_planes) {
  const ForceArrays solved(solved_planes);
  const ForceArrays truth(true_planes);
  if (solved.frames() != truth.frames()) {
    throw Error("compare", "solved and true forces differ in their number of frames",
                "give the same frames of both");
  }
  const py::gil_scoped_release unlocked;
  Comparison comparison;
  for (std::size_t i = 0; i < solved.frames(); ++i) {
    comparison.add(solved.frame(i), truth.frame(i));
  }
  std::vector<RegionErrors> errors = {comparison.loaded()};
  for (int region = 0; region < kRegions; ++region) {
    errors.push_back(comparison.region(static_cast<Region>(region)));
  }
  return errors;
}

}  // namespace

void bind_compare(py::module_& module) {
  py::class_<RegionErrors>(module, "RegionErrors", "Errors of solved forces in one true region.")
      .def_readonly("pillars", &RegionErrors::pillars, "number of pillars")
      .def_readonly("status_mismatches", &RegionErrors::status_mismatches,
                    "pillars whose usable sensels differ from the ideal model's")
      .def_readonly("rms_n", &RegionErrors::rms_n, "RMS of |solved - true|, N")
      .def_readonly("p95_n", &RegionErrors::p95_n, "95th percentile of it, N")
      .def_readonly("rms_relative", &RegionErrors::rms_relative, "RMS of |solved - true| / |true|")
      .def_readonly("p95_relative", &RegionErrors::p95_relative, "95th percentile of it")
      .def_readonly("theta_rms_rad", &RegionErrors::theta_rms_rad, "RMS error of theta, rad")
      .def_readonly("phi_rms_rad", &RegionErrors::phi_rms_rad, "RMS error of phi, rad");
  module.def("compare", &compare, py::arg("solved"), py::arg("truth"),
             "RegionErrors of all loaded pillars, then of each Region.");
}

}  // namespace pillarfield::python
