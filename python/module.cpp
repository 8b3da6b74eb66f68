// The compiled half of the package: values and calls, NumPy arrays in and out.

#include <string>

#include "base/reworded.h"
#include "pillarfield/error.h"
#include "pillarfield/pressure_unit.h"
#include "pillarfield/version.h"
#include "python/bindings.h"
#include "solve/plan_settings.h"

namespace {

namespace py = pybind11;

py::str part_text(std::string_view part) { return py::str(part.data(), part.size()); }

/// The arguments of Python by the options of the command line.
const pillarfield::Rewording& arguments() {
  static const pillarfield::Rewording words = [] {
    pillarfield::Rewording pairs = {{"--rate HZ", "rate_hz="},
                                    {"--rate", "rate_hz="},
                                    {"--shape ROWSxCOLS", "frame_size=(ROWS, COLS)"},
                                    {"--shape", "frame_size="},
                                    {"--axes ", "axes="},
                                    {"--axes", "axes="},
                                    {"--columns ", "columns="},
                                    {"--columns", "columns="},
                                    {"--where ", "where="},
                                    {"--where", "where="},
                                    {"--dataset", "dataset="},
                                    {"--times", "times="},
                                    {"--layout", "layout="},
                                    {"--falling", "falling=True"},
                                    {"--tare-frames", "tare_frames="},
                                    {"--preloaded", "preloaded=True"},
                                    {"--trust-input", "trust=True"},
                                    {"--overwrite", "overwrite=True"},
                                    {"--contacts", "contacts=True"},
                                    {"--device", "device="}};
    for (const pillarfield::PlanSetting& setting : pillarfield::kPlanSettings) {
      if (setting.option != nullptr) {
        pairs.emplace_back(setting.option, setting.name + std::string("="));
      }
    }
    return pairs;
  }();
  return words;
}

void translate(std::exception_ptr pointer) {
  try {
    std::rethrow_exception(std::move(pointer));
  } catch (const pillarfield::Error& thrown) {
    const pillarfield::Error error = reworded(thrown, arguments());
    const py::object type = py::module_::import("pillarfield._error").attr("Error");
    const py::object raised =
        type(part_text(error.place()), part_text(error.failure()), part_text(error.mend()));
    PyErr_SetObject(type.ptr(), raised.ptr());
  }
}

/// Refuses objects made by __new__ alone: pybind11 would allocate their value without constructing
/// it, and read that.
void* refuse_to_allocate(std::size_t) {
  throw py::type_error("the object was not constructed: call its class, not __new__()");
}

/// kPa of each unit of pressure by its name.
py::dict pressure_units() {
  py::dict units;
  for (const auto& unit : pillarfield::kPressureUnits) units[part_text(unit.name)] = unit.kpa;
  return units;
}

void require_construction(const py::module_& module) {
  for (const auto& [name, item] : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(item.ptr())) continue;
    auto* const bound = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(item.ptr()));
    if (bound != nullptr) bound->operator_new = refuse_to_allocate;
  }
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  using namespace pillarfield::python;
  module.attr("__version__") = pillarfield::kVersion;
  module.attr("pressure_units") = pressure_units();
  py::register_local_exception_translator(translate);
  bind_skin(module);
  bind_calibration(module);
  bind_scene(module);
  bind_plan(module);
  bind_contacts(module);
  bind_frames(module);
  bind_solve(module);
  bind_processor(module);
  bind_force_files(module);
  bind_compare(module);
  bind_calibrate(module);
  bind_doctor(module);
  bind_live(module);
  bind_picture(module);
  require_construction(module);
}
