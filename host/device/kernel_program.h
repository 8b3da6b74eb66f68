#pragma once

#include <string_view>

namespace pillarfield {

/// The program of kernels/all.h, embedded in the library: what follows a plan's macros.
std::string_view kernel_program();

}  // namespace pillarfield
