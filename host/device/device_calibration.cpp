#include "device/device_calibration.h"

#include <utility>

namespace pillarfield {

DeviceCalibration::DeviceCalibration(const cl::Context& context, CalibrationMemory planes)
    : planes_(std::move(planes)) {
  if (context() == nullptr || planes_.size() == 0) return;
  const auto device = context.getInfo<CL_CONTEXT_DEVICES>().front();
  const bool shared = device.getInfo<CL_DEVICE_HOST_UNIFIED_MEMORY>() == CL_TRUE;
  const cl_mem_flags use = shared ? CL_MEM_USE_HOST_PTR : CL_MEM_COPY_HOST_PTR;
  buffer_ = {context, CL_MEM_READ_WRITE | use, planes_.size(), planes_.bytes()};
  if (!shared) planes_.free();
}

cl::CommandQueue DeviceCalibration::queue() const {
  const auto context = buffer_.getInfo<CL_MEM_CONTEXT>();
  return {context, context.getInfo<CL_CONTEXT_DEVICES>().front()};
}

void DeviceCalibration::clear_states() const {
  if (planes_.state_bytes() == 0) return;
  const cl::CommandQueue commands = queue();
  commands.enqueueFillBuffer(buffer_, cl_float{0}, planes_.size() - planes_.state_bytes(),
                             planes_.state_bytes());
  commands.finish();
}

std::vector<float> DeviceCalibration::tare(std::size_t rows, std::size_t cols) const {
  if (buffer_() == nullptr) return planes_.tare(rows, cols);
  std::vector<float> tare(rows * cols);
  const cl::size_type row = cols * sizeof(float);
  queue().enqueueReadBufferRect(buffer_, CL_TRUE, {0, 0, 0}, {0, 0, 0}, {row, rows, 1},
                                planes_.stride() * sizeof(float), 0, row, 0, tare.data());
  return tare;
}

}  // namespace pillarfield
