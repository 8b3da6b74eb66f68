#version 450
#extension GL_GOOGLE_include_directive : require
// Fills an annular sector.
#include "bindings.glsl"

layout(location = 0) in vec2 local;
layout(location = 1) flat in vec2 radii;
layout(location = 2) flat in vec2 directions;
layout(location = 0) out vec4 colour;

void main() {
  const float pi = 3.14159265358979;
  const float radius = length(local);
  const float pixel = fwidth(radius);
  // At least two pixels thick, and two wide at its end.
  const float inner = min(radii.x, radii.y - 2.0 * pixel);
  const float margin = pixel / max(radius, 1e-6);
  float direction = atan(local.y, local.x);
  direction += 2.0 * pi * ceil((directions.x - margin - direction) / (2.0 * pi));
  if (radius < inner || radius > radii.y || direction > directions.y + margin) discard;
  colour = colour_of_word(scene.layer_colours.z);
}
