#pragma once

#include <string_view>

namespace pillarfield {

/// The program of kernels/all.h, embedded in the library; a plan's macros precede it.
std::string_view kernel_program();

}  // namespace pillarfield
