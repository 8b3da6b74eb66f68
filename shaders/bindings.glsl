// The descriptor set and access to the planes of a field.
#ifndef PILLARFIELD_SHADERS_BINDINGS
#define PILLARFIELD_SHADERS_BINDINGS

#include "shared.h"

layout(binding = kSceneBinding) uniform SceneBlock { Scene scene; };
layout(binding = kColoursBinding) uniform ColoursBlock { Colours colours; };
layout(std430, binding = kFieldBinding) readonly buffer FieldBlock { uint field[]; };
layout(std430, binding = kReadingsBinding) readonly buffer ReadingsBlock { uint readings[]; };

vec4 colour_of_word(uint word) { return unpackUnorm4x8(word); }

vec4 special_colour(uint special) {
  return colour_of_word(colours.entries[kFirstSpecial + special].x);
}

vec2 pitch_mm() { return vec2(scene.sheet.z, scene.relief.z); }  // of columns, of rows

bool has_plane(uint plane) { return plane != kNoPlane; }

float plane_value(uint plane, uint pillar) { return uintBitsToFloat(field[plane + pillar]); }

uint status_of(uint pillar) {
  return field[scene.force.w + (pillar >> 2u)] >> (8u * (pillar & 3u)) & 255u;
}

// The status byte: kernels/pillar/status.h.
bool is_usable(uint status) { return (status & 15u) != 0u; }
bool is_pressed(uint status) { return (status & 47u) != 0u; }
bool is_ambiguous(uint status) { return (status & 16u) != 0u; }
bool is_saturated(uint status) { return (status & 32u) != 0u; }
bool is_inconsistent(uint status) { return (status & 64u) != 0u; }
bool is_from_contact(uint status) { return (status & 128u) != 0u; }

#endif
