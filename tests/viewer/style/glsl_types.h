#pragma once

#include <cmath>

/// As much of GLSL as surface.glsl needs to be C++.
namespace glsl {

using uint = unsigned;  // NOLINT(readability-identifier-naming): GLSL's name, as those below

struct vec2 {  // NOLINT(readability-identifier-naming)
  float x, y;
  vec2(float first, float second) : x(first), y(second) {}
};

struct vec4 {  // NOLINT(readability-identifier-naming)
  float x, y, z, w;
};

struct vec3 {  // NOLINT(readability-identifier-naming)
  float x, y, z;
  vec3(float first, float second, float third) : x(first), y(second), z(third) {}
};

struct mat3 {  // NOLINT(readability-identifier-naming)
  vec3 first, second, third;
  mat3(vec3 a, vec3 b, vec3 c) : first(a), second(b), third(c) {}
};

using std::cos;
using std::sin;
using std::sqrt;

}  // namespace glsl
