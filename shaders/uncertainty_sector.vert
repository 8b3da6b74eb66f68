#version 450
#extension GL_GOOGLE_include_directive : require
// The uncertainty sector of an ambiguous pillar's shear: an annular sector in the tangent plane
// between the ends of its direction and length. Cells are single pillars.
#include "bindings.glsl"
#include "surface.glsl"

layout(location = 0) out vec2 local;                // mm from the arrow's tail, in the tangent plane
layout(location = 1) flat out vec2 radii;           // mm
layout(location = 2) flat out vec2 directions;      // rad, ascending

void main() {
  const uvec2 size = scene.cells.wz;
  const uvec2 index = scene.cells.yx + uvec2(gl_InstanceIndex % size.x, gl_InstanceIndex / size.x);
  const uint pillar = index.y * scene.grid.y + index.x;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // Outside: no sector.
  if (!is_ambiguous(status_of(pillar))) return;
  if (plane_value(scene.span.y, pillar) > 9e37) return;  // Saturated sensels leave it open.

  const float pi = 3.14159265358979;
  const float low = plane_value(scene.span.x, pillar) * sin(plane_value(scene.incline.x, pillar));
  const float high = plane_value(scene.span.y, pillar) * sin(plane_value(scene.incline.y, pillar));
  radii = vec2(min(low, high), max(low, high)) * scene.arrow.x;
  // The force acts opposite to the direction from which it comes.
  const float first = plane_value(scene.span.z, pillar) + pi;
  float second = plane_value(scene.span.w, pillar) + pi;
  if (second < first) second += 2.0 * pi;
  directions = vec2(first, second);

  const vec2 corners[6] = vec2[6](vec2(-1, -1), vec2(1, -1), vec2(-1, 1), vec2(-1, 1), vec2(1, -1), vec2(1, 1));
  local = corners[gl_VertexIndex] * radii.y * 1.02;
  const vec2 middle = vec2(index) + 0.5 - 0.5 * vec2(scene.grid.yx);
  const vec2 sheet = vec2(middle.x, -middle.y) * pitch_mm();
  const vec2 shear = vec2(plane_value(scene.force.x, pillar), plane_value(scene.force.y, pillar));
  const mat3 basis = surface_basis(sheet, scene.surface);
  const vec2 tail = local - scene.arrow.w * shear * scene.arrow.x;
  const vec3 place = surface_position(sheet, scene.surface) +
                     basis * vec3(tail, 0.02 * scene.sheet.z);
  gl_Position = scene.clip_from_world * vec4(place, 1.0);
}
