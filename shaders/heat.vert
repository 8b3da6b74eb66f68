#version 450
#extension GL_GOOGLE_include_directive : require
// The mesh of the skin, without vertex buffers: six vertices per tile.
#include "bindings.glsl"
#include "surface.glsl"
#include "relief.glsl"

layout(constant_id = kReliefConstant) const bool kRelief = false;

layout(location = 0) out vec2 sheet_mm;
layout(location = 1) out vec3 place_mm;

void main() {
  const uvec2 corners[6] = uvec2[6](uvec2(0, 0), uvec2(1, 0), uvec2(0, 1), uvec2(0, 1), uvec2(1, 0), uvec2(1, 1));
  const uint tile = uint(gl_VertexIndex) / 6u;
  const uvec2 mesh = scene.grid.zw;
  const uvec2 corner = uvec2(tile % mesh.x, tile / mesh.x) + corners[uint(gl_VertexIndex) % 6u];
  sheet_mm = (vec2(corner) / vec2(mesh) - 0.5) * scene.sheet.xy;
  place_mm = surface_position(sheet_mm, scene.surface);
  if (kRelief) place_mm += relief_at(sheet_mm) * surface_basis(sheet_mm, scene.surface)[2];
  gl_Position = scene.clip_from_world * vec4(place_mm, 1.0);
}
