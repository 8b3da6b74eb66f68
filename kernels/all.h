/* The ordered list of the kernel files. C++ includes it in a namespace, once per precision
 * (host/solve/pillar_maths.h), and in a struct for lanes of the host (host/lanes/lane_program.h);
 * CMake embeds its files as one OpenCL C program, which clang lints. */
/* clang-format off */
#include "portable.h"
#include "frame/stage_table.h"
#include "plan.h"
#include "pillar/status.h"
#include "pillar/pillar_model.h"
#ifndef PF_WHOLE /* The other programs compute fractions. */
#include "pillar/elementary.h"
#endif
#include "pillar/sensel.h"
#include "pillar/direct_solve.h"
#ifndef PF_WHOLE
#include "pillar/sensel_force.h"
#include "pillar/wires.h"
#include "pillar/curve.h"
#include "pillar/leak.h"
#include "pillar/memory.h"
#include "pillar/release.h"
#include "pillar/lean.h"
#include "pillar/paper_solve.h"
#include "pillar/angles.h"
#include "pillar/uncertainty.h"
#include "pillar/direction_interval.h"
#include "pillar/corrected_interval.h"
#endif
#include "frame/layout.h"
#include "frame/result_planes.h"
#if !defined(PF_WHOLE) && (!defined(__cplusplus) || PF_PRECISION == 32)
#include "frame/wire_sweep.h"
#endif
#include "frame/stages.h"
#include "frame/correct_solution.h"
#if !defined(__cplusplus) || defined(PF_LANES)
#ifdef __cplusplus
#include "frame/load_store_lanes.h"
#else
#include "frame/load_store.h"
#endif
#include "frame/wire_vectors.h"
#include "frame/calibration_planes.h"
#include "frame/idle.h"
#include "frame/idle_tiles.h"
#include "frame/block.h"
#include "frame/row_blocks.h"
#include "frame/memory_planes.h"
#include "frame/neighbours.h"
#include "frame/find_wires.cl"
#include "frame/bend_tare.cl"
#include "frame/solve_frame.cl"
#include "frame/correct_forces.cl"
#include "frame/follow_baseline.cl"
#endif
