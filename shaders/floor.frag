#version 450
#extension GL_GOOGLE_include_directive : require
// Lines in steps of a round length, in a pool of light that fades outwards.
#include "bindings.glsl"

layout(location = 0) in vec2 place;
layout(location = 0) out vec4 colour;

void main() {
  const vec2 steps = place / scene.ground.y;
  const vec2 width = fwidth(steps);
  const vec2 apart = abs(fract(steps - 0.5) - 0.5) / width;  // pixels
  const vec2 lines = clamp(1.0 - apart, 0.0, 1.0) * clamp(2.0 - 6.0 * width, 0.0, 1.0);
  const float light = 1.0 - smoothstep(0.3, 1.0, length(place) / scene.ground.z);
  colour = colour_of_word(scene.layer_colours.w);
  colour.a *= light * (0.12 + 0.5 * max(lines.x, lines.y));
}
