// The surface under the skin: pose_at() of pillarfield/surface.h in single precision. `surface`
// holds the unit vector of a cylinder's bent direction, the radius in millimetres, positive where
// the skin is outside, and the SurfaceShape.
#ifndef PF_SURFACE_GLSL
#define PF_SURFACE_GLSL

const float PF_SURFACE_PLANE = 0.0f;
const float PF_SURFACE_CYLINDER = 1.0f;
const float PF_SURFACE_SPHERE = 2.0f;

// Unit vector, on the sheet, of the direction that is bent at a point.
vec2 surface_along(vec2 sheet, vec4 surface) {
  if (surface.w != PF_SURFACE_SPHERE) return vec2(surface.x, surface.y);
  float arc = sqrt(sheet.x * sheet.x + sheet.y * sheet.y);
  return arc > 0.0f ? vec2(sheet.x / arc, sheet.y / arc) : vec2(1.0f, 0.0f);
}

// Position in space of a point of the sheet (x right, y up, from its middle).
vec3 surface_position(vec2 sheet, vec4 surface) {
  if (surface.w == PF_SURFACE_PLANE) return vec3(sheet.x, sheet.y, 0.0f);
  vec2 along = surface_along(sheet, surface);
  float angle = (along.x * sheet.x + along.y * sheet.y) / surface.z;
  float across = along.x * sheet.y - along.y * sheet.x;
  float away = surface.z * sin(angle);
  float half_sine = sin(0.5f * angle);
  return vec3(away * along.x - across * along.y, away * along.y + across * along.x,
              -2.0f * surface.z * half_sine * half_sine);
}

// Columns: unit tangents along x and y of the sheet, and the outward normal.
mat3 surface_basis(vec2 sheet, vec4 surface) {
  if (surface.w == PF_SURFACE_PLANE) {
    return mat3(vec3(1.0f, 0.0f, 0.0f), vec3(0.0f, 1.0f, 0.0f), vec3(0.0f, 0.0f, 1.0f));
  }
  vec2 along = surface_along(sheet, surface);
  float angle = (along.x * sheet.x + along.y * sheet.y) / surface.z;
  float sine = sin(angle);
  float cosine = cos(angle);
  // The tangent is (cosine along, -sine), the straight direction (-along.y, along.x, 0).
  float mixed = (cosine - 1.0f) * along.x * along.y;
  return mat3(vec3(cosine * along.x * along.x + along.y * along.y, mixed, -sine * along.x),
              vec3(mixed, cosine * along.y * along.y + along.x * along.x, -sine * along.y),
              vec3(sine * along.x, sine * along.y, cosine));
}

#endif
