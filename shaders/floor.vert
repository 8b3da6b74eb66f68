#version 450
#extension GL_GOOGLE_include_directive : require
// The floor under a skin in space: a square behind everything else.
#include "bindings.glsl"

layout(location = 0) out vec2 place;  // mm

void main() {
  const vec2 corners[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(-1, 1), vec2(1, -1), vec2(1, 1));
  place = corners[gl_VertexIndex] * scene.ground.z;
  gl_Position = scene.clip_from_world * vec4(place, scene.ground.x, 1.0);
  gl_Position.z = 0.9999 * gl_Position.w;  // Also beyond the far plane.
}
