// placeholder until the picture helper's
#ifndef PILLARFIELD_SHADERS_SURFACE
#define PILLARFIELD_SHADERS_SURFACE
vec3 surface_position(vec2 sheet, uint kind, float radius) { return vec3(sheet, 0.0); }
mat3 surface_basis(vec2 sheet, uint kind, float radius) { return mat3(1.0); }
#endif
