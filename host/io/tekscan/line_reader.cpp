#include "io/tekscan/line_reader.h"

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

LineReader::LineReader(std::filesystem::path path, const char* mend_long)
    : path_(std::move(path)),
      mend_long_(mend_long),
      file_(std::fopen(path_.c_str(), "rb")),
      buffer_(2 * kLongestLine) {
  if (!file_) throw Error(path_.string(), std::strerror(errno), "check its permissions");
}

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

std::string LineReader::place() const { return fmt::format("{}:{}", path_.string(), number_); }

/// Moves the unread bytes to the front and fills the rest of the buffer.
void LineReader::fill() {
  std::move(&buffer_[begin_], &buffer_[end_], buffer_.data());
  end_ -= begin_;
  begin_ = 0;
  end_ += std::fread(&buffer_[end_], 1, buffer_.size() - 1 - end_, file_.get());
  if (std::ferror(file_.get()) == 0) return;
  throw Error(path_.string(), "cannot be read to its end", "use another copy");
}

}  // namespace pillarfield
