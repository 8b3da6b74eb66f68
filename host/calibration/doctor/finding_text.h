#pragma once

#include "pillarfield/doctor.h"

namespace pillarfield {

/// Adds a finding, with its sentence.
void add(Diagnosis& found, ArrayFinding finding);

}  // namespace pillarfield
