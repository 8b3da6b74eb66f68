#version 450
#extension GL_GOOGLE_include_directive : require
// The heat map: colours each pixel by the value of its pillar.
#include "value.glsl"

layout(constant_id = kReliefConstant) const bool kRelief = false;

layout(location = 0) in vec2 sheet_mm;
layout(location = 1) in vec3 place_mm;
layout(location = 0) out vec4 colour;

const float kMostSamples = 6.0;

// Value of a pixel that covers `pillars` (columns, rows) around `centre`: the mean over pillars in
// contact, so that a contact smaller than a pixel keeps its colour, or the value of a single pillar.
// Adds the status bits of all of them to `flags`.
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
      const float value = value_of(pillar, status);
      if (!is_usable(status)) continue;
      sum += value;
      count += 1.0;
    }
  }
  return sum / count;  // NaN without contact.
}

// Entry of a value in the colour table.
uint entry_of(float value) {
  if (isnan(value)) return kFirstSpecial + kIdle;
  const int entry = int(floor((value - scene.range.x) / scene.range.y * 256.0));
  return uint(kScale == kCyclic ? entry & 255 : clamp(entry, 0, 255));
}

bool on_hatch() {
  // In floats: CPU drivers do not vectorise an integer remainder.
  const float period = float(scene.shown.y);
  const float along = floor(gl_FragCoord.x) + floor(gl_FragCoord.y);
  return along - period * floor((along + 0.5) / period) < floor((period + 3.0) / 4.0);
}

// Light from the upper left, on either side of the surface; 1 where it lies flat.
float shade() {
  const vec3 light = normalize(vec3(-0.5, 0.45, 0.74));
  const vec3 normal = normalize(cross(dFdx(place_mm), dFdy(place_mm)));
  return clamp(0.3 + 0.7 * abs(dot(normal, light)) / light.z, 0.3, 1.25);
}

void main() {
  const vec2 place = pillar_place(sheet_mm);
  const uint pillar = pillar_at(place);
  uint status = status_of(pillar);
  const float value = kMeans
      ? mean_value(place, max(abs(dFdx(place)), abs(dFdy(place))), status)
      : value_of(pillar, status);

  uint special = special_of(status);
  const uint entry = special != kMapped ? kFirstSpecial + special : entry_of(value);
  colour = colour_of_word(colours.entries[entry].x);
  if (special == kMapped && is_ambiguous(status) && scene.shown.x != 0u && on_hatch()) {
    colour = mix(colour, special_colour(kAmbiguous), 0.6);
  }
  if (kRelief) colour.rgb *= shade();
}
