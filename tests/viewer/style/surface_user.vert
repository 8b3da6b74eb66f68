// Uses all of surface.glsl, so that the compiler sees it.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "surface.glsl"

layout(location = 0) in vec2 sheet;
layout(location = 0) out vec3 normal;

void main() {
  const vec4 surface = vec4(1.0, 0.0, 30.0, PF_SURFACE_CYLINDER);
  gl_Position = vec4(surface_position(sheet, surface), 1.0);
  normal = surface_basis(sheet, surface)[2];
}
