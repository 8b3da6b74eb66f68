#include "io/proposal.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace pillarfield {
namespace {

/// Some size of so many sensels: a stand-in for the one that only the user knows.
FrameSize some_size(std::size_t sensels) {
  auto rows = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(sensels)));
  while (rows > 1 && sensels % rows != 0) --rows;
  return {rows, static_cast<std::uint32_t>(sensels / rows)};
}

/// The words of the first proposal that the reader takes, which may itself need one more; empty
/// without.
std::string working_words(const ProposingError& error, const Opener& open, int more) {
  for (const Proposal& proposal : error.proposals()) {
    ReadOptions options = proposal.options;
    std::string words = proposal.words;
    if (proposal.readings > 0 && !options.frame_size) {
      options.frame_size = some_size(proposal.readings);
      words += " --shape ROWSxCOLS";
    }
    const bool is_timed = !options.untimed && !options.rate_hz;
    options.untimed = true;
    try {
      const auto source = open(options);
      if (is_timed && !source->states_times() && source->frames() > 1) words += " --rate HZ";
      return words;
    } catch (const ProposingError& next) {
      const std::string further = more > 0 ? working_words(next, open, more - 1) : "";
      if (!further.empty()) return proposal.words + " " + further;
    } catch (const Error&) {
    }
  }
  return {};
}

}  // namespace

Error settled(const ProposingError& error, const Opener& open) {
  const std::string words = working_words(error, open, 1);
  if (words.empty()) return error;
  return {error.place(), error.failure(), fmt::format("{} {}", error.lead(), words)};
}

}  // namespace pillarfield
