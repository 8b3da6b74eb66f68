#include "pillarfield/error.h"
#include "python/bindings.h"

namespace pillarfield::python {
namespace {

namespace py = pybind11;

py::str part_text(std::string_view part) { return py::str(part.data(), part.size()); }

void translate(std::exception_ptr pointer) {
  try {
    std::rethrow_exception(std::move(pointer));
  } catch (const Error& error) {
    const py::object type = py::module_::import("pillarfield._error").attr("Error");
    const py::object raised =
        type(part_text(error.place()), part_text(error.failure()), part_text(error.mend()));
    PyErr_SetObject(type.ptr(), raised.ptr());
  }
}

}  // namespace

void bind_errors() { py::register_local_exception_translator(translate); }

}  // namespace pillarfield::python
