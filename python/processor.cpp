#include "pillarfield/processor.h"

#include "python/bindings.h"

namespace pillarfield::python {

void bind_processor(pybind11::module_&) {}

}  // namespace pillarfield::python
