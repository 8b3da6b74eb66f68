// The value of a pillar, by the operations of value_of() in viewer/style/quantity.cpp.
#ifndef PILLARFIELD_SHADERS_VALUE
#define PILLARFIELD_SHADERS_VALUE

#include "bindings.glsl"

layout(constant_id = kQuantityConstant) const uint kQuantity = kNormal;
layout(constant_id = kScaleConstant) const uint kScale = kSequential;
layout(constant_id = kReadingsConstant) const uint kReadings = kReadings8;
layout(constant_id = kMeansConstant) const bool kMeans = true;

// Grid coordinates of a point of the sheet: columns from the left, rows from the top.
vec2 pillar_place(vec2 sheet) {
  return vec2(sheet.x, -sheet.y) / pitch_mm() + 0.5 * vec2(scene.grid.yx);
}

uint pillar_at(vec2 place) {
  const ivec2 index = clamp(ivec2(floor(place)), ivec2(0), ivec2(scene.grid.yx) - 1);
  return uint(index.y) * scene.grid.y + uint(index.x);
}

float reading(uint row, uint col) {
  const uint index = row * scene.readings.y + col;
  if (kReadings == kReadings8) {
    return float(readings[index >> 2u] >> (8u * (index & 3u)) & 255u);
  }
  if (kReadings == kReadings16) {
    return float(readings[index >> 1u] >> (16u * (index & 1u)) & 65535u);
  }
  return uintBitsToFloat(readings[index]);
}

float parity_of(uint pillar) {
  const uint row = 2u * (pillar / scene.grid.y);
  const uint col = 2u * (pillar % scene.grid.y);
  const float v1 = reading(row, col + 1u);
  const float v2 = reading(row, col);
  const float v3 = reading(row + 1u, col);
  const float v4 = reading(row + 1u, col + 1u);
  return (v1 + v3) - (v2 + v4);
}

float uncertainty_of(uint pillar, uint status) {
  const bool sheared = has_plane(scene.deviation.x);  // A sensel has no shear.
  const float x = sheared ? plane_value(scene.deviation.x, pillar) : 0.0;
  const float y = sheared ? plane_value(scene.deviation.y, pillar) : 0.0;
  const float z = plane_value(scene.deviation.z, pillar);
  const float deviation = sqrt((x * x + y * y) + z * z);
  if (!is_ambiguous(status)) return deviation;
  const float half_span =
      0.5 * (plane_value(scene.span.y, pillar) - plane_value(scene.span.x, pillar));
  return half_span > deviation ? half_span : deviation;
}

float shear_of(uint pillar) {
  const float x = plane_value(scene.force.x, pillar);
  const float y = plane_value(scene.force.y, pillar);
  return sqrt(x * x + y * y);
}

float value_of(uint pillar, uint status) {
  switch (kQuantity) {
    case kNormal: return plane_value(scene.force.z, pillar);
    case kPressure: return plane_value(scene.force.z, pillar) * scene.sheet.w;
    case kShear: return shear_of(pillar);
    case kShearX: return plane_value(scene.force.x, pillar);
    case kShearY: return plane_value(scene.force.y, pillar);
    case kMagnitude: return plane_value(scene.angles.x, pillar);
    case kTheta: return plane_value(scene.angles.y, pillar);
    case kPhi: return plane_value(scene.angles.z, pillar);
    case kUncertainty: return uncertainty_of(pillar, status);
    case kParity: return parity_of(pillar);
  }
  return 0.0;
}

// The special colour of a pillar, or kMapped: special_of() of viewer/style/colour_map.h.
const uint kMapped = 0xffffffffu;

uint region_colour(uint usable) {
  if (usable == 5u || usable == 10u) return kOpposite;
  return kRegion1 + 4u - uint(bitCount(usable));
}

uint special_of(uint status) {
  const uint usable = status & 15u;
  if (kQuantity == kRegion && usable != 0u) return region_colour(usable);
  if (is_inconsistent(status)) return is_pressed(status) ? kInconsistent : kNoReading;
  if (is_saturated(status)) return kSaturated;
  if (usable == 0u) return kIdle;
  if (kQuantity != kStatus) return kQuantity == kRegion ? kIdle : kMapped;
  if (is_from_contact(status)) return kFromContact;
  return is_ambiguous(status) ? kAmbiguous : kDetermined;
}

#endif
