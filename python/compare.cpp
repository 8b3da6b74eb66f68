#include <fmt/format.h>
#include <pybind11/stl.h>

#include <vector>

#include "pillarfield/comparison.h"
#include "pillarfield/error.h"
#include "pillarfield/resultant_comparison.h"
#include "python/bindings.h"
#include "python/force_planes.h"
#include "python/pitch.h"

namespace pillarfield::python {
namespace {

/// A view with shear of zeros, if it has none.
ForceFieldView with_shear(ForceFieldView forces, const std::vector<float>& zeros) {
  if (forces.shear_x.empty()) forces.shear_x = forces.shear_y = zeros;
  return forces;
}

py::tuple compare(const py::dict& solved_planes, const py::dict& true_planes,
                  const Pitch& pitch_mm) {
  const ForceArrays solved(solved_planes);
  const ForceArrays truth(true_planes);
  if (solved.frames() != truth.frames()) {
    throw Error("compare", "solved and true forces differ in their number of frames",
                "give the same frames of both");
  }
  Comparison comparison;
  ResultantComparison resultants(pitch_mm);
  {
    const py::gil_scoped_release unlocked;
    const std::vector<float> zeros(std::size_t{truth.rows()} * truth.cols());
    for (std::size_t i = 0; i < solved.frames(); ++i) {
      comparison.add(solved.frame(i), truth.frame(i));
      resultants.add(with_shear(solved.frame(i), zeros), with_shear(truth.frame(i), zeros));
    }
  }
  std::vector<RegionErrors> regions;
  for (int region = 0; region < kRegions; ++region) {
    regions.push_back(comparison.region(static_cast<Region>(region)));
  }
  const ResultantErrors& patch = resultants.patch();
  const ContactErrors& contacts = resultants.contacts();
  using namespace py::literals;
  return py::make_tuple(
      comparison.loaded(), regions, py::dict("force"_a = patch.force, "torque"_a = patch.torque),
      py::dict("found"_a = contacts.found, "missed"_a = contacts.missed, "extra"_a = contacts.extra,
               "missed_normal_n"_a = contacts.missed_normal_n,
               "extra_normal_n"_a = contacts.extra_normal_n, "force"_a = contacts.force,
               "torque"_a = contacts.torque, "centre"_a = contacts.centre));
}

}  // namespace

void bind_compare(py::module_& module) {
  py::class_<RegionErrors>(module, "RegionErrors", "Errors of solved forces in one true region.")
      .def_readonly("pillars", &RegionErrors::pillars, "number of pillars")
      .def_readonly("status_mismatches", &RegionErrors::status_mismatches,
                    "pillars whose usable sensels differ from the ideal model's")
      .def_readonly("rms_n", &RegionErrors::rms_n, "RMS of |solved - true|, N")
      .def_readonly("p95_n", &RegionErrors::p95_n, "95th percentile of it, N")
      .def_readonly("rms_relative", &RegionErrors::rms_relative,
                    "RMS of |solved - true| / |true|, pillar by pillar: those that barely touch "
                    "count like the others")
      .def_readonly("p95_relative", &RegionErrors::p95_relative, "95th percentile of it")
      .def_readonly("theta_rms_rad", &RegionErrors::theta_rms_rad, "RMS error of theta, rad")
      .def_readonly("phi_rms_rad", &RegionErrors::phi_rms_rad, "RMS error of phi, rad")
      .def("__repr__", [](const RegionErrors& self) {
        return fmt::format("<RegionErrors: {} pillars, RMS {:.3g} N, 95 % below {:.3g} N>",
                           self.pillars, self.rms_n, self.p95_n);
      });
  py::class_<VectorErrors>(module, "VectorErrors",
                           "Lengths of a vector's errors over several cases, in its unit.")
      .def_readonly("cases", &VectorErrors::cases, "number of frames, or of contacts in frames")
      .def_readonly("rms", &VectorErrors::rms, "RMS of |solved - true|, N, N mm or mm")
      .def_readonly("worst", &VectorErrors::worst, "the largest |solved - true|, N, N mm or mm")
      .def_readonly("worst_frame", &VectorErrors::worst_frame, "its frame, from 0")
      .def_readonly("worst_true", &VectorErrors::worst_true, "|true| there, N, N mm or mm")
      .def_readonly("true_rms", &VectorErrors::true_rms, "RMS of |true|, N, N mm or mm")
      .def("__repr__", [](const VectorErrors& self) {
        return fmt::format("<VectorErrors: {} cases, RMS {:.3g} of {:.3g}, worst {:.3g}>",
                           self.cases, self.rms, self.true_rms, self.worst);
      });
  module.def("compare", &compare, py::arg("solved"), py::arg("truth"), py::arg("pitch_mm"),
             "RegionErrors of all loaded pillars and of each Region, "
             "errors of the resultant, errors of contacts.");
}

}  // namespace pillarfield::python
