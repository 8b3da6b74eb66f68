#include "streams/live_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "base/nearest_word.h"
#include "io/skin_constants.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"

namespace pillarfield {

// Each is defined beside its source.
LiveSourceKind stdin_kind();
LiveSourceKind ring_kind();
LiveSourceKind udp_kind();
LiveSourceKind serial_kind();

namespace {

const LiveSourceKind* kind_of_source(std::string_view source) {
  const auto kinds = live_source_kinds();
  const auto found = std::ranges::find_if(kinds, [&](const LiveSourceKind& kind) {
    return kind.prefix == "-" ? source == "-" : source.starts_with(kind.prefix);
  });
  return found == kinds.end() ? nullptr : &*found;
}

std::string forms_of_sources() {
  std::string forms;
  for (const LiveSourceKind& kind : live_source_kinds()) {
    forms += fmt::format("{}{}", forms.empty() ? "" : ", ", kind.form);
  }
  return forms;
}

/// "; did you mean 'udp:'?" for a misspelt kind, else empty.
std::string suggested_source(std::string_view source) {
  const std::size_t colon = source.find(':');
  if (colon == std::string_view::npos || kind_of_source(source) != nullptr) return {};
  std::vector<std::string> prefixes;
  for (const LiveSourceKind& kind : live_source_kinds()) prefixes.emplace_back(kind.prefix);
  return suggestion(source.substr(0, colon + 1), prefixes);
}

}  // namespace

std::span<const LiveSourceKind> live_source_kinds() {
  static const std::array kinds = {stdin_kind(), ring_kind(), udp_kind(), serial_kind()};
  return kinds;
}

bool is_live_source(std::string_view source) {
  return kind_of_source(source) != nullptr ||
         (!source.starts_with('.') && !source.starts_with('/') &&
          !suggested_source(source).empty() && !std::filesystem::exists(source));
}

std::unique_ptr<FrameStream> open_live_source(const std::string& source,
                                              const LiveSourceOptions& options) {
  const LiveSourceKind* const kind = kind_of_source(source);
  if (kind == nullptr) {
    throw Error(printable(source), "it is not a live source",
                fmt::format("give one of {}{}", forms_of_sources(), suggested_source(source)));
  }
  if (const auto given = given_file_options(options.read); !given.empty()) {
    throw Error(printable(source),
                fmt::format("{} is for files, and this is a live source", given.front()),
                given.front() == "--tare-frames"
                    ? "leave it out; take the tare live, or give --calibration FILE"
                    : "leave it out");
  }
  return kind->open(source.substr(kind->prefix.size()), options);
}

}  // namespace pillarfield
