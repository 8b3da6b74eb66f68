// The compiled half of the package: values and calls, NumPy arrays in and out.

#include "pillarfield/version.h"
#include "python/bindings.h"

PYBIND11_MODULE(_core, module) {
  using namespace pillarfield::python;
  module.attr("__version__") = pillarfield::kVersion;
  bind_errors();
  bind_skin(module);
  bind_calibration(module);
  bind_scene(module);
  bind_plan(module);
  bind_contacts(module);
  bind_frames(module);
  bind_solve(module);
  bind_processor(module);
  bind_force_files(module);
  bind_parts(module);
  bind_compare(module);
  bind_calibrate(module);
  bind_live(module);
  bind_picture(module);
}
