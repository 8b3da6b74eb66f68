#include "base/reworded.h"

#include <algorithm>
#include <cctype>

namespace pillarfield {

std::string reworded(std::string_view text, const Rewording& words) {
  const auto is_of_word = [&](std::size_t at) {
    return at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 ||
                                text[at] == '_' || text[at] == '-');
  };
  std::string result;
  for (std::size_t at = 0; at < text.size();) {
    const auto begins = [&](const auto& pair) {
      return text.substr(at).starts_with(pair.first) && !is_of_word(at + pair.first.size());
    };
    const auto found =
        at > 0 && is_of_word(at - 1) ? words.end() : std::ranges::find_if(words, begins);
    result += found == words.end() ? std::string(1, text[at]) : found->second;
    at += found == words.end() ? 1 : found->first.size();
  }
  return result;
}

Error reworded(const Error& error, const Rewording& words) {
  const std::string mend(error.mend());
  if (mend.find("in Python") != std::string::npos) return error;
  return {error.place(), error.failure(), reworded(mend, words)};
}

}  // namespace pillarfield
