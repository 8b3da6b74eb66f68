#include "streams/source/serial_search.h"

#include <fmt/format.h>
#include <glob.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/source/byte_source.h"
#include "streams/source/flexitac_parser.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;

constexpr std::array kUsbLines = {"/dev/ttyUSB*", "/dev/ttyACM*"};

std::vector<std::string> devices_of(const std::string& pattern) {
  std::vector<std::string> devices;
  const auto add = [&](const char* names) {
    glob_t found = {};
    if (glob(names, 0, nullptr, &found) == 0) {
      devices.insert(devices.end(), found.gl_pathv, found.gl_pathv + found.gl_pathc);
    }
    globfree(&found);
  };
  if (pattern == "auto") {
    for (const char* const names : kUsbLines) add(names);
  } else {
    add(pattern.c_str());
  }
  return devices;
}

/// Readings of the frames that arrive within a second, or words on what arrived instead.
struct Heard {
  std::size_t readings = 0;
  std::string words = {};
};

Heard listen(int line, const std::function<bool()>& stop) {
  constexpr std::size_t kMostBytes = 1 << 18;
  std::vector<std::byte> bytes(kMostBytes);
  std::size_t size = 0;
  const auto until = steady_now() + 1s;
  while (size < kMostBytes && steady_now() < until && !(stop && stop())) {
    const BytesRead read = read_bytes(line, std::span(bytes).subspan(size), 50ms);
    if (read.ended) break;
    size += read.bytes;
    if (const auto distance = mark_distance(std::span(bytes).first(size))) {
      return {.readings = *distance - FlexitacParser::kMarkBytes};
    }
  }
  const std::string words = words_on_bytes(std::span(bytes).first(size));
  return {.words = size == 0       ? "is silent"
                   : words.empty() ? "sends other bytes"
                                   : "sends " + words};
}

/// The bytes at the head of frames of this length that are the same in all of them, two to eight,
/// first of all the longest; those that are 0 do not count. Empty without.
std::string head_of(std::span<const std::byte> bytes, std::size_t frame) {
  constexpr std::size_t kLongest = 8;
  std::string longest;
  std::string head;
  for (std::size_t first = 0; first < frame + kLongest && first + frame < bytes.size(); ++first) {
    bool is_same = bytes[first] != std::byte{0};
    for (std::size_t at = first; is_same && at < bytes.size(); at += frame) {
      is_same = bytes[at] == bytes[first];
    }
    head = is_same ? head + static_cast<char>(bytes[first]) : "";
    if (head.size() > longest.size()) longest = head;
  }
  return longest.size() <= kLongest ? longest : longest.substr(0, kLongest);
}

/// True if the head of frames goes on from here: a byte that never changes, though others do, and
/// is unlike the readings at rest.
bool goes_on(std::span<const std::byte> bytes, std::size_t from, std::size_t frame) {
  constexpr int kUnlike = 32;
  std::vector<std::byte> sorted(bytes.begin(), bytes.end());
  std::ranges::nth_element(sorted, sorted.begin() + std::ssize(sorted) / 2);
  const int rest = std::to_integer<int>(sorted[sorted.size() / 2]);
  std::size_t constant = 0;
  bool is_unlike = false;
  for (std::size_t first = from; first < std::min(from + frame, bytes.size()); ++first) {
    bool is_same = true;
    for (std::size_t at = first; is_same && at < bytes.size(); at += frame) {
      is_same = bytes[at] == bytes[first];
    }
    if (!is_same) continue;
    ++constant;
    is_unlike = is_unlike ||
                (first < from + 2 && std::abs(std::to_integer<int>(bytes[first]) - rest) > kUnlike);
  }
  return is_unlike && 2 * constant < frame;
}

}  // namespace

std::optional<std::size_t> mark_distance(std::span<const std::byte> bytes) {
  constexpr std::size_t kFirst = 4;  // marks that may begin the frames; a reading may look like one
  constexpr std::size_t kLeast = 8;
  std::vector<std::size_t> marks;
  for (std::size_t at = 0; at + 1 < bytes.size(); ++at) {
    if (FlexitacParser::is_mark(&bytes[at])) marks.push_back(at);
  }
  std::optional<std::size_t> shortest;
  std::size_t begin = 0;
  for (std::size_t first = 0; first < std::min(kFirst, marks.size()); ++first) {
    for (std::size_t second = first + 1; second < marks.size(); ++second) {
      const std::size_t distance = marks[second] - marks[first];
      if (shortest && distance >= *shortest) break;
      std::size_t count = 1;
      std::size_t at = marks[second];
      for (; at + 1 < bytes.size() && FlexitacParser::is_mark(&bytes[at]); at += distance) ++count;
      if (at + 1 < bytes.size() || count < kLeast) continue;
      shortest = distance;
      begin = marks[first];
    }
  }
  const bool is_flexitac = shortest && (*shortest - FlexitacParser::kMarkBytes) % 4 == 0 &&
                           !goes_on(bytes, begin + FlexitacParser::kMarkBytes, *shortest);
  return is_flexitac ? shortest : std::nullopt;
}

std::string words_on_bytes(std::span<const std::byte> bytes) {
  constexpr std::size_t kMostBytes = 1 << 14;
  constexpr std::size_t kLeastBytes = 64;
  constexpr std::size_t kLeastFrames = 8;
  constexpr std::size_t kLeastFrame = 8;
  bytes = bytes.first(std::min(bytes.size(), kMostBytes));
  if (bytes.size() < kLeastBytes) return {};
  const auto is_text = [](std::byte byte) {
    return (byte >= std::byte{' '} && byte <= std::byte{'~'}) || byte == std::byte{'\n'} ||
           byte == std::byte{'\r'} || byte == std::byte{'\t'};
  };
  if (10 * static_cast<std::size_t>(std::ranges::count_if(bytes, is_text)) > 9 * bytes.size())
    return "lines of text, which are not read live; save them to a file";
  for (std::size_t bytes_a_frame = kLeastFrame; bytes_a_frame * kLeastFrames <= bytes.size();
       ++bytes_a_frame) {
    const std::string head = head_of(bytes, bytes_a_frame);
    if (head.size() < 2) continue;
    std::string hex;
    for (const char byte : head) hex += fmt::format(" {:02X}", static_cast<unsigned char>(byte));
    return fmt::format(
        "frames of {} bytes that begin with{}, of a board that is not known; a "
        "program of yours can send them as packets (docs/streams.md)",
        bytes_a_frame, hex);
  }
  return {};
}

std::optional<FrameSize> likely_size(std::size_t readings) {
  for (auto rows = static_cast<std::size_t>(std::sqrt(static_cast<double>(readings))); rows >= 2;
       --rows) {
    if (readings % rows != 0) continue;
    return FrameSize{static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(readings / rows)};
  }
  return std::nullopt;
}

std::optional<FoundBoard> find_board(const std::string& pattern, const LiveSourceOptions& options,
                                     const std::function<int(const std::string&)>& open) {
  const std::string name = printable("serial:" + pattern);
  const std::vector<std::string> devices = devices_of(pattern);
  if (devices.empty()) {
    throw Error(name,
                fmt::format("no device is {}", pattern == "auto"
                                                   ? fmt::format("{}", fmt::join(kUsbLines, " or "))
                                                   : printable(pattern)),
                "plug the board in, or give serial:DEVICE");
  }
  std::string heard;
  for (const std::string& device : devices) {
    const int line = open(device);
    const Heard here =
        line < 0 ? Heard{.words = fmt::format("cannot be opened: {}", std::strerror(errno))}
                 : listen(line, options.stop);
    if (line >= 0) close(line);
    if (here.readings > 0) return FoundBoard{device, here.readings};
    if (options.stop && options.stop()) return std::nullopt;
    heard += fmt::format("{}{} {}", heard.empty() ? "" : ", ", printable(device), here.words);
  }
  throw Error(
      name, fmt::format("no frames of a FlexiTac board at {} baud: {}", options.serial_baud, heard),
      "switch the board on, check the baud rate, or give serial:DEVICE for packets");
}

}  // namespace pillarfield
