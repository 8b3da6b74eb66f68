// Structs and constants shared by C++ and GLSL. All members have 16 bytes, so that std140, std430
// and C++ give the same layout.
#ifndef PILLARFIELD_SHADERS_SHARED_H
#define PILLARFIELD_SHADERS_SHARED_H

#ifdef __cplusplus
#include <array>
#include <cstdint>

namespace pillarfield::viewer::shader {

using uint = std::uint32_t;
struct vec4 {
  float x = 0, y = 0, z = 0, w = 0;
};
struct uvec4 {
  uint x = 0, y = 0, z = 0, w = 0;
};
using mat4 = std::array<float, 16>;  ///< column by column
#define PF_CONSTANT inline constexpr
#define PF_ARRAY(type, name, size) std::array<type, size> name
#else
#define PF_CONSTANT const
#define PF_ARRAY(type, name, size) type name[size]
#endif

// Bindings of the common descriptor set.
PF_CONSTANT uint kSceneBinding = 0u;
PF_CONSTANT uint kColoursBinding = 1u;
PF_CONSTANT uint kFieldBinding = 2u;
PF_CONSTANT uint kReadingsBinding = 3u;
PF_CONSTANT uint kCellsBinding = 4u;

// Specialisation constants of the heat map's shader: CPU drivers execute every branch for every
// pixel.
PF_CONSTANT uint kQuantityConstant = 0u;  // kNormal, ...
PF_CONSTANT uint kScaleConstant = 1u;     // kSequential, ...
PF_CONSTANT uint kReadingsConstant = 2u;  // kReadings8, ...
PF_CONSTANT uint kMeansConstant = 3u;     // true: a pixel may show the mean of several pillars
PF_CONSTANT uint kReliefConstant =
    4u;  // true: in space, lit and perhaps raised by the normal force

// Quantities, in the order of Quantity in viewer/style/quantity.h.
PF_CONSTANT uint kNormal = 0u;
PF_CONSTANT uint kShear = 1u;
PF_CONSTANT uint kShearX = 2u;
PF_CONSTANT uint kShearY = 3u;
PF_CONSTANT uint kMagnitude = 4u;
PF_CONSTANT uint kTheta = 5u;
PF_CONSTANT uint kPhi = 6u;
PF_CONSTANT uint kRegion = 7u;
PF_CONSTANT uint kStatus = 8u;
PF_CONSTANT uint kUncertainty = 9u;
PF_CONSTANT uint kParity = 10u;
PF_CONSTANT uint kPressure = 11u;

// Scales, in the order of Scale in viewer/style/quantity.h.
PF_CONSTANT uint kSequential = 0u;
PF_CONSTANT uint kDiverging = 1u;
PF_CONSTANT uint kCyclic = 2u;
PF_CONSTANT uint kClasses = 3u;

// Colours outside the maps, in the order of Special in viewer/style/colour_map.h.
PF_CONSTANT uint kIdle = 0u;
PF_CONSTANT uint kSaturated = 1u;
PF_CONSTANT uint kInconsistent = 2u;
PF_CONSTANT uint kAmbiguous = 3u;
PF_CONSTANT uint kFromContact = 4u;
PF_CONSTANT uint kRegion1 = 5u;
PF_CONSTANT uint kRegion2 = 6u;
PF_CONSTANT uint kRegion3 = 7u;
PF_CONSTANT uint kRegion4 = 8u;
PF_CONSTANT uint kOpposite = 9u;
PF_CONSTANT uint kDetermined = 10u;
PF_CONSTANT uint kNoReading = 11u;

// Offset of a missing plane.
PF_CONSTANT uint kNoPlane = 0xffffffffu;

// Types of readings, in the order of SenselType.
PF_CONSTANT uint kReadings8 = 0u;
PF_CONSTANT uint kReadings16 = 1u;
PF_CONSTANT uint kReadingsFloat = 2u;

// Uniform data of one picture. Planes are offsets in the field's memory, in 4-byte words.
struct Scene {
  mat4 clip_from_world;
  vec4 sheet;           // width, height, pitch of columns: mm; kPa of a newton on it
  vec4 surface;         // as in surface.glsl
  uvec4 grid;           // rows and columns of pillars or sensels; columns and rows of the mesh
  uvec4 force;          // planes: shear_x, shear_y, normal, status
  uvec4 angles;         // planes: magnitude, theta, phi, none
  uvec4 deviation;      // planes: standard deviations of shear_x, shear_y, normal; none
  uvec4 span;           // planes: magnitude_low, magnitude_high, phi_low, phi_high
  uvec4 incline;        // planes: theta_low, theta_high; none, none
  uvec4 readings;       // none, readings per row, 1 with readings, none
  uvec4 shown;          // 1: hatch ambiguous pillars; hatch period: pixels; none, none
  vec4 range;           // low end, width; smallest force with an arrow: N per pillar; none
  vec4 viewport;        // left, top, width, height: pixels
  uvec4 cells;          // first row and column of pillars, rows and columns of cells
  uvec4 block;          // pillars along a cell; 1: top view; none
  vec4 arrow;           // mm per newton; least length, half width: pixels; fraction of the length
                        // before the anchor
  uvec4 layer_colours;  // colours of an arrow's fill, its outline, a sector, the floor
  vec4
      relief;  // height: mm per newton of normal force, 0 without; largest, pitch of rows: mm; none
  vec4 ground;  // floor: height, distance of its lines, half its side: mm; none
};

// 256 colours of the map and, from kFirstSpecial on, those of Special, for a single look-up. Each
// is red + green·2^8 + blue·2^16 + alpha·2^24 in the first member; indexing members is slower.
PF_CONSTANT uint kFirstSpecial = 256u;
struct Colours {
  PF_ARRAY(uvec4, entries, 272);
};

// Sum of the forces under an arrow's cell.
struct Cell {
  vec4 force;  // shear_x, shear_y, normal: N; pillars in contact
  vec4 place;  // x, y on the sheet, mean of pillars in contact: mm; none
};

#ifdef __cplusplus
#undef PF_CONSTANT
#undef PF_ARRAY
static_assert(sizeof(Scene) == 64 + 18 * 16);
static_assert(sizeof(Colours) == 272 * 16);
static_assert(sizeof(Cell) == 32);

}  // namespace pillarfield::viewer::shader
#endif

#endif
