#include "io/plain/inflater.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <utility>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {

class Inflater::State {
 public:
  State(const InputFile& file, const DeflatedData& data, std::string place, const char* mend)
      : file_(file), data_(data), place_(std::move(place)), mend_(mend) {
    if (inflateInit2(&stream_, data.has_zlib_header ? MAX_WBITS : -MAX_WBITS) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~State() { inflateEnd(&stream_); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::size_t read(std::span<std::byte> bytes) {
    const std::size_t wanted = bytes.size();
    while (!bytes.empty() && !has_ended_) {
      if (is_interrupted()) throw Error(place_, "interrupted while it was read", "start again");
      if (stream_.avail_in == 0) fill();
      const auto room = static_cast<uInt>(std::min<std::size_t>(bytes.size(), 16U << 20U));
      stream_.next_out = reinterpret_cast<Bytef*>(bytes.data());
      stream_.avail_out = room;
      const int result = ::inflate(&stream_, Z_NO_FLUSH);
      bytes = bytes.subspan(room - stream_.avail_out);
      if (result == Z_STREAM_END) has_ended_ = true;
      const bool is_stuck = result == Z_BUF_ERROR && stream_.avail_in == 0 && read_ == data_.bytes;
      if (is_stuck || (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR)) {
        throw Error(place_, "cannot be decompressed", mend_);
      }
    }
    return wanted - bytes.size();
  }

 private:
  void fill() {
    const std::uint64_t count = std::min<std::uint64_t>(input_.size(), data_.bytes - read_);
    file_.read(data_.at + read_, std::span(input_).first(count));
    read_ += count;
    stream_.next_in = reinterpret_cast<Bytef*>(input_.data());
    stream_.avail_in = static_cast<uInt>(count);
  }

  const InputFile& file_;
  DeflatedData data_;
  std::string place_;
  const char* mend_;
  z_stream stream_ = {};
  std::vector<std::byte> input_ = std::vector<std::byte>(64U << 10U);
  std::uint64_t read_ = 0;
  bool has_ended_ = false;
};

Inflater::Inflater(const InputFile& file, const DeflatedData& data, std::string place,
                   const char* mend)
    : state_(std::make_unique<State>(file, data, std::move(place), mend)) {}
Inflater::~Inflater() = default;
Inflater::Inflater(Inflater&& other) noexcept = default;

std::size_t Inflater::read(std::span<std::byte> bytes) { return state_->read(bytes); }

}  // namespace pillarfield
