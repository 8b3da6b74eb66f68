#pragma once

// kernels/maths as C++: in single precision, which matches the device bit for bit, and in double.

#include <bit>
#include <cmath>
#include <cstdint>

namespace pillarfield::single_precision {
#define PF_PRECISION 32
#include "kernels/portable.h"
// portable.h first
#include "kernels/maths/elementary.h"
#include "kernels/maths/status.h"
// then what the others are made of
#include "kernels/maths/pillar_model.h"
#include "kernels/maths/sensel.h"
// and what is made of them
#include "kernels/maths/angles.h"
#include "kernels/maths/direct_solve.h"
#include "kernels/maths/half.h"
// and the rest
#include "kernels/maths/paper_solve.h"
#include "kernels/maths/uncertainty.h"
#undef PF_PRECISION
}  // namespace pillarfield::single_precision

namespace pillarfield::double_precision {
#define PF_PRECISION 64
#include "kernels/portable.h"
// as above
#include "kernels/maths/elementary.h"
// as above
#include "kernels/maths/pillar_model.h"
#include "kernels/maths/sensel.h"
// as above
#include "kernels/maths/angles.h"
#include "kernels/maths/direct_solve.h"
// as above
#include "kernels/maths/paper_solve.h"
#include "kernels/maths/uncertainty.h"
#undef PF_PRECISION
}  // namespace pillarfield::double_precision
