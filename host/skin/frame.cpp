#include "pillarfield/frame.h"

#include <fmt/format.h>

#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

std::shared_ptr<std::byte[]> memory_of_frame(std::size_t bytes) {
  constexpr std::align_val_t kPage{4096};
  return {static_cast<std::byte*>(::operator new[](bytes, kPage)),
          [](std::byte* memory) { ::operator delete[](memory, kPage); }};
}

}  // namespace

FrameBuffer::FrameBuffer(SenselType type, std::uint32_t rows, std::uint32_t cols)
    : FrameBuffer(type, rows, cols, memory_of_frame(std::size_t{rows} * cols * size_of(type))) {}

FrameBuffer::FrameBuffer(SenselType type, std::uint32_t rows, std::uint32_t cols,
                         std::shared_ptr<std::byte[]> memory)
    : type_(type),
      rows_(rows),
      cols_(cols),
      size_(std::size_t{rows} * cols * size_of(type)),
      data_(std::move(memory)) {
  std::memset(data_.get(), 0, size_);
}

FrameView FrameBuffer::view() const { return {data_.get(), type_, rows_, cols_, cols_}; }

void mirror(FrameBuffer& frame) {
  const auto each = [](auto readings, auto top) {
    for (auto& reading : readings) {
      reading = static_cast<std::remove_reference_t<decltype(reading)>>(top - reading);
    }
  };
  switch (frame.view().type) {
    case SenselType::u8:
      return each(frame.readings<std::uint8_t>(), 255);
    case SenselType::u16:
      return each(frame.readings<std::uint16_t>(), 65535);
    case SenselType::f32:
      break;
  }
  each(frame.readings<float>(), 0.0F);
}

void copy_readings(const FrameView& frame, std::byte* to) {
  const std::size_t row_bytes = frame.cols * size_of(frame.type);
  const auto* from = static_cast<const std::byte*>(frame.data);
  for (std::uint32_t row = 0; row < frame.rows; ++row, to += row_bytes) {
    std::memcpy(to, from + row * frame.row_stride * size_of(frame.type), row_bytes);
  }
}

void check(const FrameView& frame, const Skin& skin, SenselType type, std::string_view where) {
  if (frame.rows != skin.rows || frame.cols != skin.cols || frame.type != type) {
    throw Error(where,
                fmt::format("the frame is {} x {} {}", frame.rows, frame.cols, name_of(frame.type)),
                fmt::format("it must be {} x {} {}", skin.rows, skin.cols, name_of(type)));
  }
  if (frame.data == nullptr) throw Error(where, "the frame has no data", "set FrameView::data");
  if (frame.row_stride < frame.cols) {
    throw Error(where, fmt::format("row_stride is {}", frame.row_stride),
                fmt::format("it counts readings and must be at least cols, {}", frame.cols));
  }
}

}  // namespace pillarfield
