#include "io/tekscan/line_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kLongestLine = 1 << 20;

}  // namespace

LineReader::LineReader(std::filesystem::path path, const char* mend_long)
    : file_(std::move(path)), mend_long_(mend_long), buffer_(2 * kLongestLine) {}

bool LineReader::next() {
  std::string_view rest(&buffer_[begin_], end_ - begin_);
  if (rest.find('\n') == std::string_view::npos) {
    fill();
    rest = {&buffer_[begin_], end_ - begin_};
  }
  if (rest.empty()) return false;
  ++number_;
  line_ = rest.substr(0, rest.find('\n'));
  if (line_.size() > kLongestLine)
    throw Error(place(), "the line is longer than any line of an export", mend_long_);
  begin_ = std::min(begin_ + line_.size() + 1, end_);
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  return true;
}

std::string LineReader::place() const {
  return fmt::format("{}:{}", file_.path().string(), number_);
}

/// Moves the unread bytes to the front and fills the rest of the buffer.
void LineReader::fill() {
  std::move(&buffer_[begin_], &buffer_[end_], buffer_.data());
  end_ -= begin_;
  begin_ = 0;
  const std::uint64_t count =
      std::min<std::uint64_t>(buffer_.size() - 1 - end_, file_.size() - offset_);
  file_.read(offset_, std::as_writable_bytes(std::span(&buffer_[end_], count)));
  offset_ += count;
  end_ += count;
}

}  // namespace pillarfield
