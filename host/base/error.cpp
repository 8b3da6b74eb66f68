#include "pillarfield/error.h"

#include <algorithm>

#include "pillarfield/printable.h"

namespace pillarfield {
namespace {

std::string one_line(std::string_view text) {
  std::string line(text);
  std::ranges::replace_if(
      line, [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return printable(line);
}

}  // namespace

struct Error::Parts {
  std::string place, failure, mend;

  [[nodiscard]] std::string text() const {
    return (place.empty() ? "" : place + ": ") + failure + (mend.empty() ? "" : "; " + mend);
  }
};

Error::Error(std::string_view where, std::string_view what_failed, std::string_view mend)
    : Error(Parts{one_line(where), one_line(what_failed), one_line(mend)}) {}

Error::Error(const Parts& parts)
    : std::runtime_error(parts.text()),
      place_length_(parts.place.size()),
      failure_begin_(parts.place.empty() ? 0 : parts.place.size() + 2),
      failure_length_(parts.failure.size()) {}

std::string_view Error::place() const { return std::string_view(what()).substr(0, place_length_); }

std::string_view Error::failure() const {
  return std::string_view(what()).substr(failure_begin_, failure_length_);
}

std::string_view Error::mend() const {
  const std::string_view rest = std::string_view(what()).substr(failure_begin_ + failure_length_);
  return rest.empty() ? rest : rest.substr(2);
}

}  // namespace pillarfield
