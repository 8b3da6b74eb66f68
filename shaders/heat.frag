#version 450
#extension GL_GOOGLE_include_directive : require
// The heat map: from a pixel to its pillar, the pillar's value, and the value's colour.
#include "value.glsl"

layout(location = 0) in vec2 sheet_mm;
layout(location = 0) out vec4 colour;

const float kMostSamples = 6.0;

// The value shown by a pixel that covers `pillars` (columns, rows) around `centre`: the mean over
// those in contact, so that a touch smaller than a pixel keeps its colour. A pixel that stays
// within a pillar shows that one alone. `flags`: what the statuses of all of them have.
float mean_value(vec2 centre, vec2 pillars, inout uint flags) {
  const bool one_pillar = max(pillars.x, pillars.y) < 1.5;
  const vec2 samples = one_pillar ? vec2(1.0) : min(ceil(pillars), vec2(kMostSamples));
  float sum = 0.0;
  float count = 0.0;
  for (float j = 0.5; j < samples.y; j += 1.0) {
    for (float i = 0.5; i < samples.x; i += 1.0) {
      const uint pillar = pillar_at(centre + (vec2(i, j) / samples - 0.5) * pillars);
      const uint status = status_of(pillar);
      flags |= status;
      if (!is_usable(status)) continue;
      sum += value_of(pillar, status);
      count += 1.0;
    }
  }
  return sum / count;  // 0/0, not a number, where nothing is in contact.
}

vec4 mapped(float value) {
  int entry = int(floor((value - scene.range.x) / scene.range.y * 256.0));
  entry = kScale == kCyclic ? entry & 255 : clamp(entry, 0, 255);
  return colour_of_word(colours.entries[entry >> 2][entry & 3]);
}

bool on_hatch() {
  const uint period = scene.shown.y;
  return (uint(gl_FragCoord.x) + uint(gl_FragCoord.y)) % period < (period + 3u) / 4u;
}

void main() {
  const vec2 place = pillar_place(sheet_mm);
  const uint pillar = pillar_at(place);
  uint status = status_of(pillar);
  const float value = kMeans
      ? mean_value(place, max(abs(dFdx(place)), abs(dFdy(place))), status)
      : value_of(pillar, status);

  const uint special = special_of(status);
  if (special != kMapped) {
    colour = special_colour(special);
    return;
  }
  colour = isnan(value) ? special_colour(kIdle) : mapped(value);
  if (is_ambiguous(status) && scene.shown.x != 0u && on_hatch()) {
    colour = mix(colour, special_colour(kAmbiguous), 0.6);
  }
}
