// kernels/frame as C++ with vectors of PF_LANES lanes. Compiled once for each instruction set: the
// build defines PF_LANE_PROGRAM, its name as a variable, PF_LANE_NAME and the lanes of numbers and
// of whole numbers. All code is inlined into the entry points, so that nothing compiled here for a
// processor is called on another one.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include "lanes/lane_plan.h"

#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#pragma GCC diagnostic ignored "-Wunused-parameter"

namespace pillarfield {
namespace {

using std::size_t;
// The words of OpenCL C.
// NOLINTBEGIN(readability-identifier-naming)
using uchar = std::uint8_t;
using ushort = std::uint16_t;
using uint = std::uint32_t;
using ulong = std::uint64_t;

// Those of lanes/lane_plan.h.
#undef PF_PRECISION
#include "lanes/forget_kernels.h"

#undef INFINITY
#define global
#define constant const
#define kernel inline __attribute__((always_inline))
#define restrict __restrict
#define INFINITY __builtin_inff()
// NOLINTEND(readability-identifier-naming)

#define PF_PRECISION 32
#define PF_SKIP_IDLE
#define PF_ACTIVATION_PLANE (given->planes.activation)
#define PF_TARE_PLANE (given->planes.tare)
#define PF_GAIN_PLANE (given->planes.gain)
#define PF_DEAD_ZONE_PLANE (given->planes.dead_zone)
#define PF_HAS_NOISE_PLANE (given->planes.has_noise)
#define PF_NOISE_PLANE (given->planes.noise)
#define PF_MASK_PLANE (given->planes.mask)
#define PF_BEND_X_PLANE (given->planes.bend_x)
#define PF_BEND_Y_PLANE (given->planes.bend_y)
#define PF_BEND_XY_PLANE (given->planes.bend_xy)
#define PF_RELEASE_PLANE (given->planes.release)
#define PF_MEMORY_PLANE (given->planes.memory)
#define PF_PLAYS (named.memory_model.plays)
#define PF_CREEPS (named.memory_model.creeps)
#define PF_TILE_ROWS (given->tile_rows)
#define PF_TILE_COLS (given->tile_cols)
#define PF_MOST_TILE_ROWS 1024
#define PF_MOST_TILE_PARTS 1024

/// Base of both programs: the work-item that runs.
struct WorkItem {
  const LanePlan* given;
  LaneRange range{};
  LaneRange at{0, 0};

  [[nodiscard]] size_t get_global_id(int dimension) const {
    return dimension == 0 ? at.across : at.down;
  }
  [[nodiscard]] size_t get_global_size(int dimension) const {
    return dimension == 0 ? range.across : range.down;
  }
};

#define PF_SENSEL float
#define PF_LANES PF_NUMBER_LANES
struct Numbers : WorkItem {
#include "kernels/all.h"
};
#undef PF_LANES
#undef PF_SENSEL
#undef PF_HAS_NOISE_PLANE
#undef PF_NOISE_PLANE
#undef PF_ACTIVATION_PLANE
#include "lanes/forget_kernels.h"
#define PF_SENSEL uchar
#define PF_LANES PF_WHOLE_LANES
#define PF_WHOLE 16
struct WholeNumbers : WorkItem {
#include "kernels/all.h"
};

/// A program with the numbers of a plan. A local variable: stores to results cannot change it.
template <class Program>
Program program_of(const LanePlan& plan, LaneRange range) {
  Program program{};
  program.given = &plan;
  program.range = range;
  static_assert(sizeof(program.named) == sizeof(plan.stages));
  std::memcpy(&program.named, &plan.stages, sizeof(program.named));
  return program;
}

template <class To, class From>
To same_bits(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to{};
  std::memcpy(&to, &from, sizeof(to));
  return to;
}

template <class Program, class Run>
void for_each_item(const LanePlan& plan, const LaneFrame& frame, LaneRange range, size_t first,
                   size_t last, Run run) {
  auto program = program_of<Program>(plan, range);
  const auto layout = same_bits<typename Program::Layout>(frame.layout);
  for (program.at.down = first; program.at.down < last; ++program.at.down) {
    for (program.at.across = 0; program.at.across < range.across; ++program.at.across) {
      run(program, layout);
    }
  }
}

#define PF_DEFINE_RUN(name)                                                                        \
  void name(const LanePlan& plan, const LaneFrame& frame, LaneRange range, size_t first,           \
            size_t last) {                                                                         \
    for_each_item<Numbers>(plan, frame, range, first, last,                                        \
                           [&](Numbers& program, const Numbers::Layout& l) {                       \
                             program.name(static_cast<const float*>(frame.raw), frame.calibration, \
                                          frame.results, l, &program.named);                       \
                           });                                                                     \
  }
PF_DEFINE_RUN(find_wires)
PF_DEFINE_RUN(remove_pillar_leak)
PF_DEFINE_RUN(find_shear_ratios)
PF_DEFINE_RUN(correct_forces)
PF_DEFINE_RUN(solve_frame)
#undef PF_DEFINE_RUN

void solve_any_frame(const LanePlan& plan, const LaneFrame& frame, LaneRange range, size_t first,
                     size_t last) {
  if (!plan.whole) return solve_frame(plan, frame, range, first, last);
  for_each_item<WholeNumbers>(
      plan, frame, range, first, last, [&](WholeNumbers& program, const WholeNumbers::Layout& l) {
        program.solve_frame(static_cast<const uchar*>(frame.raw), frame.calibration, frame.results,
                            l, &program.named);
      });
}

void bend_tare(const LanePlan& plan, const LaneFrame& frame,
               const single_precision::Curvature& change) {
  auto program = program_of<Numbers>(plan, {});
  program.bend_tare(nullptr, frame.calibration, frame.results,
                    same_bits<Numbers::Layout>(frame.layout), &program.named, change.x, change.y,
                    change.xy);
}

void follow_baseline(const LanePlan& plan, const LaneFrame& frame,
                     const single_precision::BaselinePace& pace,
                     const single_precision::Drift& drift, std::uint32_t first_row,
                     std::uint32_t interval) {
  auto program = program_of<Numbers>(plan, {});
  program.follow_baseline(static_cast<const float*>(frame.raw), frame.calibration, frame.results,
                          same_bits<Numbers::Layout>(frame.layout), &program.named,
                          same_bits<Numbers::BaselinePace>(pace), same_bits<Numbers::Drift>(drift),
                          first_row, interval);
}

}  // namespace

extern const LaneProgram PF_LANE_PROGRAM;
const LaneProgram PF_LANE_PROGRAM = {
    PF_LANE_NAME,       PF_NUMBER_LANES,   PF_WHOLE_LANES, find_wires, solve_any_frame,
    remove_pillar_leak, find_shear_ratios, correct_forces, bend_tare,  follow_baseline};

}  // namespace pillarfield
