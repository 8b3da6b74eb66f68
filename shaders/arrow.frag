#version 450
#extension GL_GOOGLE_include_directive : require
// Draws an outlined arrow, shaft and head, by its distance function.
#include "bindings.glsl"

layout(location = 0) noperspective in vec2 local;
layout(location = 1) noperspective in float arrow_length;
layout(location = 0) out vec4 colour;

// Signed distance to a triangle with its tip at (tip, 0) and `half_width` at (base, 0).
float head_distance(vec2 point, float base, float tip, float half_width) {
  const vec2 side = normalize(vec2(half_width, tip - base));  // Outward normal of the slanted side.
  return max(dot(point - vec2(tip, 0.0), side), base - point.x);
}

float shaft_distance(vec2 point, float end, float half_width) {
  const vec2 excess = vec2(max(-point.x, point.x - end), point.y - half_width);
  return max(excess.x, excess.y);
}

void main() {
  const float half_width = scene.arrow.z;
  const vec2 point = vec2(local.x, abs(local.y));
  const float head = min(3.6 * half_width, 0.75 * arrow_length);
  const float base = arrow_length - head;
  const float distance = min(head_distance(point, base, arrow_length, 2.2 * half_width),
                             shaft_distance(point, base + 0.5, 0.75 * half_width));
  const float inside = clamp(0.5 - distance, 0.0, 1.0);
  const float outlined = clamp(1.6 - distance, 0.0, 1.0);
  if (outlined <= 0.0) discard;
  const vec4 fill = colour_of_word(scene.layer_colours.x);
  const vec4 outline = colour_of_word(scene.layer_colours.y);
  colour = vec4(mix(outline.rgb, fill.rgb, inside), outlined * mix(outline.a, fill.a, inside));
}
