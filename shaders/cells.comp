#version 450
#extension GL_GOOGLE_include_directive : require
// Level of detail: the forces of block x block pillars, added, for each cell in sight.
#include "bindings.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kCellsBinding) writeonly buffer CellsBlock { Cell cells[]; };

void main() {
  const uint index = gl_GlobalInvocationID.x;
  const uvec2 size = scene.cells.wz;  // columns, rows
  if (index >= size.x * size.y) return;
  const uint block = scene.block.x;
  const uvec2 first = scene.cells.yx + uvec2(index % size.x, index / size.x) * block;
  const uvec2 last = min(first + block, scene.grid.yx);

  vec4 sum = vec4(0.0);
  uvec2 places = uvec2(0);
  for (uint row = first.y; row < last.y; ++row) {
    for (uint col = first.x; col < last.x; ++col) {
      const uint pillar = row * scene.grid.y + col;
      if (!is_usable(status_of(pillar))) continue;
      sum += vec4(plane_value(scene.force.x, pillar), plane_value(scene.force.y, pillar),
                  plane_value(scene.force.z, pillar), 1.0);
      places += uvec2(col, row) - first;
    }
  }
  // The middle of those in contact: at the edge of a contact the arrow stays upon it.
  const vec2 place =
      vec2(first) + vec2(places) / max(sum.w, 1.0) + 0.5 - 0.5 * vec2(scene.grid.yx);
  cells[index].force = sum;
  cells[index].place = vec4(place.x * scene.sheet.z, -place.y * scene.sheet.z, 0.0, 0.0);
}
