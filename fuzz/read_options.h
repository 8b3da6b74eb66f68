#pragma once

// Goes, and "pillarfield/read_options.h" takes its place, once the readers take options.
#if __has_include("pillarfield/read_options.h")
#include "pillarfield/read_options.h"
#define PILLARFIELD_FUZZ_OPTIONS(options) , options
#else
namespace pillarfield {
struct ReadOptions {
  bool trust = false;
};
}  // namespace pillarfield
#define PILLARFIELD_FUZZ_OPTIONS(options)
#endif
