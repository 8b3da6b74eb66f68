#pragma once

// kernels/pillar as C++: in single precision, which matches the device bit for bit, and in double.

#include <bit>
#include <cmath>
#include <cstdint>

namespace pillarfield::single_precision {
#define PF_PRECISION 32
#include "kernels/portable.h"
// portable.h first
#include "kernels/pillar/elementary.h"
#include "kernels/pillar/status.h"
// then what the others are made of
#include "kernels/pillar/pillar_model.h"
#include "kernels/pillar/sensel.h"
// and what is made of them
#include "kernels/pillar/angles.h"
#include "kernels/pillar/direct_solve.h"
// and the rest
#include "kernels/pillar/paper_solve.h"
#include "kernels/pillar/uncertainty.h"
#undef PF_PRECISION
}  // namespace pillarfield::single_precision

namespace pillarfield::double_precision {
#define PF_PRECISION 64
#include "kernels/portable.h"
// as above
#include "kernels/pillar/elementary.h"
// as above
#include "kernels/pillar/pillar_model.h"
#include "kernels/pillar/sensel.h"
// as above
#include "kernels/pillar/angles.h"
#include "kernels/pillar/direct_solve.h"
// as above
#include "kernels/pillar/paper_solve.h"
#include "kernels/pillar/uncertainty.h"
#undef PF_PRECISION
}  // namespace pillarfield::double_precision
