#pragma once

#include "pillarfield/doctor.h"

namespace pillarfield {

/// True for faults of rows, false for those of columns.
[[nodiscard]] bool is_of_rows(ArrayFault fault);

/// Adds a finding, with its sentence.
void add(Diagnosis& found, ArrayFinding finding);

}  // namespace pillarfield
