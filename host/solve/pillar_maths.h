#pragma once

// The kernels as C++: in single precision, which matches the device bit for bit, and in double.

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace pillarfield::single_precision {
#define PF_PRECISION 32
#include "kernels/all.h"
#undef PF_PRECISION
}  // namespace pillarfield::single_precision

namespace pillarfield::double_precision {
#define PF_PRECISION 64
#include "kernels/all.h"
#undef PF_PRECISION
}  // namespace pillarfield::double_precision
