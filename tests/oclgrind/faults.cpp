// One kernel, correct or with a fault, to check that a test program under Oclgrind distinguishes
// them. Each test but the last passes by itself; only Oclgrind's report fails it.

#define CL_HPP_ENABLE_EXCEPTIONS
#define CL_HPP_MINIMUM_OPENCL_VERSION 120
#define CL_HPP_TARGET_OPENCL_VERSION 120
#include <gtest/gtest.h>

#include <CL/opencl.hpp>
#include <array>

namespace {

constexpr const char* kSource =
    "kernel void write(global int* out, int stride, int shift) {"
    "  const int i = (int)get_global_id(0);"
    "  out[i * stride + shift] = i;"
    "}";
constexpr std::size_t kItems = 64;

/// Work-item i writes to element i * stride + shift of kItems; returns the first and last element.
std::array<int, 2> write(int stride, int shift) {
  const cl::Context context(CL_DEVICE_TYPE_ALL);
  const cl::CommandQueue queue(context);
  const cl::Program program(context, kSource, true);
  const cl::Buffer out(context, CL_MEM_READ_WRITE, kItems * sizeof(int));
  cl::Kernel kernel(program, "write");
  kernel.setArg(0, out);
  kernel.setArg(1, stride);
  kernel.setArg(2, shift);
  queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(kItems));

  std::array<int, 2> ends{};
  queue.enqueueReadBuffer(out, CL_TRUE, 0, sizeof(int), ends.data());
  queue.enqueueReadBuffer(out, CL_TRUE, (kItems - 1) * sizeof(int), sizeof(int), ends.data() + 1);
  return ends;
}

TEST(Write, Faultless) { EXPECT_EQ(write(1, 0), (std::array<int, 2>{0, kItems - 1})); }

TEST(Write, OutOfBounds) { EXPECT_EQ(write(1, 1)[1], kItems - 2); }

TEST(Write, Racing) { EXPECT_GE(write(0, 0)[0], 0); }

TEST(Write, Unexpected) { EXPECT_EQ(write(1, 0)[0], -1); }

}  // namespace
