#pragma once

// The OpenCL C++ bindings; only host/device includes them.

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_TARGET_OPENCL_VERSION 120
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#include <CL/opencl.hpp>
#include <string_view>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {

/// "CL_OUT_OF_RESOURCES" for -5, and so on.
std::string_view name_of_opencl_error(cl_int code);

[[noreturn]] void throw_opencl_error(std::string_view where, const cl::Error& error);

/// Calls `work`; converts an OpenCL error to an Error at `where`.
template <class Work>
decltype(auto) with_opencl_errors(std::string_view where, Work&& work) {
  try {
    return std::forward<Work>(work)();
  } catch (const cl::Error& error) {
    throw_opencl_error(where, error);
  }
}

}  // namespace pillarfield
