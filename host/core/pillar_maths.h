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
#include "kernels/maths/segment.h"
#include "kernels/maths/uncertainty.h"
// contacts, of single precision alone; with casts as C has them
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include "kernels/field/tile.h"
// as above
#include "kernels/field/trend.h"
// what needs the trend
#include "kernels/field/normal_equations.h"
#include "kernels/field/plateau.h"
#include "kernels/field/residual.h"
// and what judges by all of these
#include "kernels/field/verdict.h"
// and the scale of what slips, line by line
#include "kernels/field/flank.h"
// of all lines
#include "kernels/field/flanks.h"
// by the friction shown, by the pressure's shape
#include "kernels/field/slip.h"
// and what a shape implies
#include "kernels/field/implied.h"
// as above
#include "kernels/field/fit.h"
// the models
#include "kernels/field/shape.h"
// and what becomes of it
#include "kernels/field/judgement.h"
// in which steps
#include "kernels/field/course.h"
#include "kernels/field/step.h"
// and all of it
#include "kernels/field/resolve.h"
#pragma GCC diagnostic pop
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
