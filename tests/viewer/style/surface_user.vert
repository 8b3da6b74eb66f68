// Uses all of surface.glsl, so that the compiler sees it.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "surface.glsl"

layout(location = 0) in vec2 sheet;
layout(location = 0) out vec3 normal;

void main() {
  gl_Position = vec4(surface_position(sheet, PF_SURFACE_CYLINDER, 30.0), 1.0);
  normal = surface_basis(sheet, PF_SURFACE_CYLINDER, 30.0)[2];
}
