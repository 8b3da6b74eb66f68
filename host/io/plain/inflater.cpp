#include "io/plain/inflater.h"

#include <new>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {

Inflater::Inflater(const InputFile& file, std::uint64_t at, std::uint64_t left)
    : file_(file), at_(at), left_(left) {
  if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
}

std::size_t Inflater::read(std::span<std::byte> bytes) {
  const std::size_t wanted = bytes.size();
  while (!bytes.empty() && !has_ended_) {
    const std::string place = file_.path().string();
    if (is_interrupted()) throw Error(place, "interrupted while it was read", "start again");
    if (stream_.avail_in == 0) {
      const std::uint64_t count = std::min<std::uint64_t>(input_.size(), left_);
      file_.read(at_, std::span(input_).first(count));
      at_ += count;
      left_ -= count;
      stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
      stream_.avail_in = static_cast<uInt>(count);
    }
    const auto room = static_cast<uInt>(std::min<std::size_t>(bytes.size(), 16U << 20U));
    stream_.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream_.avail_out = room;
    const int result = ::inflate(&stream_, Z_NO_FLUSH);
    bytes = bytes.subspan(room - stream_.avail_out);
    has_ended_ = result == Z_STREAM_END;
    const bool is_stuck = result == Z_BUF_ERROR && stream_.avail_in == 0 && left_ == 0;
    if (is_stuck || (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)) {
      throw Error(place, "cannot be decompressed",
                  "the file is damaged or truncated; use another copy");
    }
  }
  return wanted - bytes.size();
}

}  // namespace pillarfield
