#include "streams/source/serial_address.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <functional>
#include <map>
#include <string_view>
#include <vector>

#include "base/nearest_word.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "pillarfield/skin.h"
#include "streams/source/flexitac_parser.h"
#include "streams/source/packet_parser.h"

namespace pillarfield {
namespace {

constexpr const char* kExample =
    "give, in quotes, 'serial:/dev/ttyUSB0?protocol=flexitac&rows=16&cols=32'";

/// The options of an address, as text.
using AddressOptions = std::map<std::string, std::string, std::less<>>;

/// Takes "rows=16" apart.
void add_option(std::string_view text, const std::string& source, AddressOptions& options) {
  static const std::vector<std::string> known = {"protocol", "rows", "cols"};
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string name(text.substr(0, equals));
  if (std::ranges::find(known, name) == known.end()) {
    throw Error(source,
                fmt::format("option '{}' is unknown{}", printable(name), suggestion(name, known)),
                fmt::format("options are {}; {}", fmt::join(known, ", "), kExample));
  }
  if (equals == text.size() || !options.emplace(name, text.substr(equals + 1)).second) {
    throw Error(
        source,
        fmt::format("option '{}' has {}", name, equals == text.size() ? "no value" : "two values"),
        kExample);
  }
}

AddressOptions options_of(std::string_view text, const std::string& source) {
  AddressOptions options;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    add_option(text.substr(0, end), source, options);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return options;
}

/// The number of rows or columns, named `name`.
std::uint32_t size_option(const AddressOptions& options, const std::string& name,
                          const std::string& source) {
  const auto found = options.find(name);
  if (found == options.end()) {
    throw Error(source, fmt::format("protocol flexitac needs rows and cols; {} is missing", name),
                kExample);
  }
  const std::string& text = found->second;
  std::uint32_t number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || rest != text.data() + text.size() || number < 2 ||
      number > kMaxSensels) {
    throw Error(
        source,
        fmt::format("{} is '{}', not a number from 2 to {}", name, printable(text), kMaxSensels),
        kExample);
  }
  return number;
}

std::unique_ptr<ByteParser> flexitac_parser(const AddressOptions& options,
                                            const std::string& source) {
  const FrameShape shape = {SenselType::u8, size_option(options, "rows", source),
                            size_option(options, "cols", source)};
  if (!is_size_allowed(shape)) {
    throw Error(source, fmt::format("{} x {} sensels are too many", shape.rows, shape.cols),
                fmt::format("give at most {} in all", PILLARFIELD_MAX_SENSELS));
  }
  return std::make_unique<FlexitacParser>(shape);
}

std::unique_ptr<ByteParser> packet_parser(const AddressOptions& options,
                                          const std::string& source) {
  if (options.contains("rows") || options.contains("cols")) {
    throw Error(source, "packets bring rows and columns",
                "add protocol=flexitac, or leave them out");
  }
  return std::make_unique<PacketParser>();
}

/// A protocol by which bytes become frames.
struct Protocol {
  const char* name = nullptr;
  std::unique_ptr<ByteParser> (*parser)(const AddressOptions& options,
                                        const std::string& source) = nullptr;
};

constexpr std::array kProtocols = {Protocol{"packets", packet_parser},
                                   Protocol{"flexitac", flexitac_parser}};

const Protocol& protocol_of(const AddressOptions& options, const std::string& source) {
  const auto given = options.find("protocol");
  if (given == options.end()) return kProtocols.front();
  std::vector<std::string> names;
  for (const Protocol& protocol : kProtocols) {
    if (given->second == protocol.name) return protocol;
    names.emplace_back(protocol.name);
  }
  throw Error(source,
              fmt::format("protocol '{}' is unknown{}", printable(given->second),
                          suggestion(given->second, names)),
              fmt::format("give one of {}; packets are the default", fmt::join(names, ", ")));
}

}  // namespace

SerialAddress serial_address(const std::string& text) {
  const std::string source = printable("serial:" + text);
  const std::size_t question = std::min(text.find('?'), text.size());
  const AddressOptions options =
      options_of(std::string_view(text).substr(std::min(question + 1, text.size())), source);
  const Protocol& protocol = protocol_of(options, source);
  return {text.substr(0, question), protocol.parser(options, source)};
}

}  // namespace pillarfield
