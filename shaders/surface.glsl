// The surface under the skin: frame_at() of viewer/style/view.h in single precision, an isometric
// map. `kind` is SurfaceKind; lengths in millimetres.
#ifndef PF_SURFACE_GLSL
#define PF_SURFACE_GLSL

const uint PF_SURFACE_CYLINDER = 1u;

// Smaller cylinders count as planes, which avoids a division by zero.
const float PF_LEAST_RADIUS_MM = 1.0e-3f;

bool surface_is_curved(uint kind, float radius) {
  return kind == PF_SURFACE_CYLINDER && radius >= PF_LEAST_RADIUS_MM;
}

// Position in space of a point of the sheet (x right, y up, from its middle).
vec3 surface_position(vec2 sheet, uint kind, float radius) {
  if (!surface_is_curved(kind, radius)) return vec3(sheet.x, sheet.y, 0.0f);
  float angle = sheet.x / radius;
  float half_sine = sin(0.5f * angle);
  return vec3(radius * sin(angle), sheet.y, -2.0f * radius * half_sine * half_sine);
}

// Columns: unit tangents along x and y of the sheet, and the outward normal.
mat3 surface_basis(vec2 sheet, uint kind, float radius) {
  float angle = surface_is_curved(kind, radius) ? sheet.x / radius : 0.0f;
  float sine = sin(angle);
  float cosine = cos(angle);
  return mat3(vec3(cosine, 0.0f, -sine), vec3(0.0f, 1.0f, 0.0f), vec3(sine, 0.0f, cosine));
}

#endif
