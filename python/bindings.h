#pragma once

#include <pybind11/pybind11.h>

/// Each function adds the classes and functions of one subject to the module.
namespace pillarfield::python {

void bind_skin(pybind11::module_& module);
void bind_calibration(pybind11::module_& module);
void bind_scene(pybind11::module_& module);
void bind_plan(pybind11::module_& module);
void bind_contacts(pybind11::module_& module);
void bind_frames(pybind11::module_& module);
void bind_solve(pybind11::module_& module);
void bind_force_files(pybind11::module_& module);
void bind_compare(pybind11::module_& module);
void bind_calibrate(pybind11::module_& module);
void bind_doctor(pybind11::module_& module);
void bind_live(pybind11::module_& module);
void bind_picture(pybind11::module_& module);
void bind_processor(pybind11::module_& module);

}  // namespace pillarfield::python
