#version 450
#extension GL_GOOGLE_include_directive : require
// Sums the forces of block x block pillars for each visible cell.
#include "bindings.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kCellsBinding) writeonly buffer CellsBlock { Cell cells[]; };

// Usable sensels of the four pillars from `four`, a multiple of 4, on: a byte each, zero for pillars
// outside [begin, end).
uint usable_of_four(uint four, uint begin, uint end) {
  uint usable = field[scene.force.w + (four >> 2u)] & 0x0f0f0f0fu;
  if (four < begin) usable &= ~0u << (8u * (begin - four));
  if (four + 4u > end) usable &= ~0u >> (8u * (four + 4u - end));
  return usable;
}

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
    const uint row_begin = row * scene.grid.y;
    const uint begin = row_begin + first.x;
    const uint end = row_begin + last.x;
    for (uint four = begin & ~3u; four < end; four += 4u) {
      for (uint bits = usable_of_four(four, begin, end); bits != 0u;) {
        const uint byte = uint(findLSB(bits)) & ~7u;
        bits &= ~(255u << byte);
        const uint pillar = four + (byte >> 3u);
        sum += vec4(plane_value(scene.force.x, pillar), plane_value(scene.force.y, pillar),
                    plane_value(scene.force.z, pillar), 1.0);
        places += uvec2(pillar - begin, row - first.y);
      }
    }
  }
  // The mean position of pillars in contact, so that an arrow at an edge lies on the contact.
  const vec2 place =
      vec2(first) + vec2(places) / max(sum.w, 1.0) + 0.5 - 0.5 * vec2(scene.grid.yx);
  cells[index].force = sum;
  cells[index].place = vec4(vec2(place.x, -place.y) * pitch_mm(), 0.0, 0.0);
}
