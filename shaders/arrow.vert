#version 450
#extension GL_GOOGLE_include_directive : require
// One arrow per cell: the force on the skin as a vector in space, on a quad that faces the eye.
// Lengths in the quad are pixels.
#include "bindings.glsl"
#include "surface.glsl"
#include "relief.glsl"

layout(std430, binding = kCellsBinding) readonly buffer CellsBlock { Cell cells[]; };
layout(location = 0) noperspective out vec2 local;        // along and across, from the tail
layout(location = 1) noperspective out float arrow_length;  // pixels

const float kMargin = 2.0;  // pixels around the arrow for its outline

vec2 pixels_of(vec4 clip) { return (clip.xy / clip.w * 0.5 + 0.5) * scene.viewport.zw; }

void main() {
  const Cell cell = cells[gl_InstanceIndex];
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // Outside: no arrow.
  if (cell.force.w == 0.0) return;
  const mat3 basis = surface_basis(cell.place.xy, scene.surface);
  const float height = relief_of(cell.force.z / cell.force.w);
  const vec3 place = surface_position(cell.place.xy, scene.surface) + height * basis[2];
  // A top view shows only shear; a normal force would put half of the arrow under the skin.
  const float pressing = scene.block.y != 0u ? 0.0 : cell.force.z;
  const vec3 way = basis * vec3(cell.force.xy, -pressing) * scene.arrow.x;
  const vec4 tail_clip = scene.clip_from_world * vec4(place - scene.arrow.w * way, 1.0);
  const vec4 tip_clip = scene.clip_from_world * vec4(place + (1.0 - scene.arrow.w) * way, 1.0);
  vec2 tail = pixels_of(tail_clip);
  vec2 tip = pixels_of(tip_clip);

  if (length(way) < scene.arrow.x * scene.range.z * cell.force.w) return;  // Too faint.

  // Lengthen short arrows about their position, so that their direction is visible.
  const float drawn = distance(tail, tip);
  if (drawn < 0.25) return;  // It points at the eye.
  const vec2 along = (tip - tail) / drawn;
  arrow_length = max(drawn, scene.arrow.y);
  const vec2 anchor = mix(tail, tip, scene.arrow.w);
  tail = anchor - along * arrow_length * scene.arrow.w;
  tip = tail + along * arrow_length;

  const float reach = 2.2 * scene.arrow.z + kMargin;
  const vec2 corners[6] = vec2[6](vec2(0, -1), vec2(1, -1), vec2(0, 1), vec2(0, 1), vec2(1, -1), vec2(1, 1));
  const vec2 corner = corners[gl_VertexIndex];
  local = vec2(mix(-kMargin, arrow_length + kMargin, corner.x), corner.y * reach);
  const vec2 pixel = tail + along * local.x + vec2(-along.y, along.x) * local.y;
  const vec4 end = mix(tail_clip, tip_clip, corner.x);
  // Slightly in front of the skin.
  gl_Position = vec4((pixel / scene.viewport.zw * 2.0 - 1.0) * end.w, end.z - 2e-4 * end.w, end.w);
}
