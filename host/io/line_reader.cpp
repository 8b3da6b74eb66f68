#include "io/line_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLongestLine = 1 << 20;

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    : path_(std::move(path)), file_(std::fopen(path_.c_str(), "rb")), buffer_(2 * kLongestLine) {
  if (!file_) throw Error(path_.string(), std::strerror(errno), "check its permissions");
}

bool LineReader::next() {
  const auto find_end = [&] { return std::find(&buffer_[begin_], &buffer_[end_], '\n'); };
  const char* line_end = find_end();
  if (line_end == &buffer_[end_] && fill()) line_end = find_end();
  if (begin_ == end_) return false;
  ++number_;
  const auto length = static_cast<std::size_t>(line_end - &buffer_[begin_]);
  if (length > kLongestLine) throw Error(place(), "the line is longer than any of an export");
  line_ = {&buffer_[begin_], length};
  begin_ = std::min(begin_ + length + 1, end_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  return true;
}

std::string LineReader::place() const { return fmt::format("{}:{}", path_.string(), number_); }

/// Moves what is left to the front and reads behind it; false where nothing more came.
bool LineReader::fill() {
  std::move(&buffer_[begin_], &buffer_[end_], buffer_.data());
  end_ -= begin_;
  begin_ = 0;
  const std::size_t got = std::fread(&buffer_[end_], 1, buffer_.size() - 1 - end_, file_.get());
  if (std::ferror(file_.get()) != 0) {
    throw Error(path_.string(), "cannot be read to its end", "take another copy");
  }
  end_ += got;
  return got > 0;
}

}  // namespace pillarfield
