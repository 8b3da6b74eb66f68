#include "pillarfield/frame.h"

#include <cstring>
#include <new>

namespace pillarfield {
namespace {

constexpr std::align_val_t kPage{4096};

}  // namespace

FrameBuffer::FrameBuffer(SenselType type, std::uint32_t rows, std::uint32_t cols)
    : type_(type),
      rows_(rows),
      cols_(cols),
      size_(std::size_t{rows} * cols * size_of(type)),
      data_(static_cast<std::byte*>(::operator new[](size_, kPage))) {
  std::memset(data_.get(), 0, size_);
}

void FrameBuffer::Free::operator()(std::byte* memory) const { ::operator delete[](memory, kPage); }

FrameView FrameBuffer::view() const { return {data_.get(), type_, rows_, cols_, cols_}; }

}  // namespace pillarfield
