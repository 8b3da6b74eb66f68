// The height of the relief: the normal force on a pillar raises the skin.
#ifndef PILLARFIELD_SHADERS_RELIEF
#define PILLARFIELD_SHADERS_RELIEF

#include "bindings.glsl"

float relief_of(float normal) {
  return isnan(normal) ? 0.0 : clamp(normal * scene.relief.x, 0.0, scene.relief.y);
}

// Height at a corner of the mesh, mm: the mean of the four pillars that meet there, or, where a tile
// of the mesh covers several pillars, the largest around it.
float relief_at(vec2 sheet) {
  const vec2 place = vec2(sheet.x, -sheet.y) / pitch_mm() + 0.5 * vec2(scene.grid.yx);
  const vec2 tile = max(vec2(scene.grid.yx) / vec2(scene.grid.zw), vec2(1.0));
  const vec2 count = min(ceil(tile) + 1.0, vec2(8.0));
  float sum = 0.0;
  float most = 0.0;
  for (float j = 0.5; j < count.y; j += 1.0) {
    for (float i = 0.5; i < count.x; i += 1.0) {
      const ivec2 index = ivec2(floor(place + (vec2(i, j) / count - 0.5) * 2.0 * tile));
      if (any(lessThan(index, ivec2(0))) || any(greaterThanEqual(index, ivec2(scene.grid.yx)))) continue;
      const uint pillar = uint(index.y) * scene.grid.y + uint(index.x);
      if (!is_usable(status_of(pillar))) continue;
      const float height = relief_of(plane_value(scene.force.z, pillar));
      sum += height;
      most = max(most, height);
    }
  }
  return max(tile.x, tile.y) < 1.5 ? sum / (count.x * count.y) : most;
}

#endif
