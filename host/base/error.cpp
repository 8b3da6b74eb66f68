#include "pillarfield/error.h"

#include "pillarfield/printable.h"

namespace pillarfield {
namespace {

std::string one_line(std::string_view where, std::string_view what_failed, std::string_view mend) {
  std::string text;
  if (!where.empty()) text.append(where).append(": ");
  text.append(what_failed);
  if (!mend.empty()) text.append("; ").append(mend);
  for (char& character : text) {
    if (character == '\n' || character == '\r' || character == '\t') character = ' ';
  }
  return printable(text);
}

}  // namespace

Error::Error(std::string_view where, std::string_view what_failed, std::string_view mend)
    : std::runtime_error(one_line(where, what_failed, mend)) {}

}  // namespace pillarfield
