// Not termios.h, which knows only some baud rates and contradicts this header.
#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/nearest_word.h"
#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "pillarfield/skin.h"
#include "streams/live_source.h"
#include "streams/source/byte_parser.h"
#include "streams/source/byte_source.h"
#include "streams/source/flexitac_parser.h"
#include "streams/source/packet_parser.h"
#include "streams/source/packet_source.h"
#include "streams/source/serial_search.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;

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
  if (error != std::errc() || rest != text.data() + text.size() || number < 1 ||
      number > kMaxSensels) {
    throw Error(
        source,
        fmt::format("{} is '{}', not a number from 1 to {}", name, printable(text), kMaxSensels),
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

/// The address after `serial:`.
struct SerialAddress {
  std::string device;
  std::unique_ptr<ByteParser> parser;  ///< of its protocol
};

/// Reads "DEVICE", whose bytes are packets, or "DEVICE?protocol=NAME&rows=ROWS&cols=COLS". Throws
/// Error, naming the source, for options that are unknown, missing or out of range.
SerialAddress serial_address(const std::string& text) {
  const std::string source = printable("serial:" + text);
  const std::size_t question = std::min(text.find('?'), text.size());
  const AddressOptions options =
      options_of(std::string_view(text).substr(std::min(question + 1, text.size())), source);
  const Protocol& protocol = protocol_of(options, source);
  return {text.substr(0, question), protocol.parser(options, source)};
}

/// Opens a serial device raw, with 8 bits and no parity; -1 and errno if that fails.
int open_serial_device(const std::string& device, std::uint32_t baud) {
  const int opened = open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) return -1;
  termios2 settings = {};
  if (ioctl(opened, TCGETS2, &settings) == 0) {
    settings.c_iflag = IGNBRK;
    settings.c_oflag = 0;
    settings.c_lflag = 0;
    settings.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
    settings.c_ispeed = baud;
    settings.c_ospeed = baud;
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
    if (ioctl(opened, TCSETS2, &settings) == 0) {
      ioctl(opened, TIOCEXCL);
      return opened;
    }
  }
  const int failure = errno;
  close(opened);
  errno = failure;
  return -1;
}

/// Packets on a serial line. It is opened again when the device disappears and returns.
class SerialSource final : public PacketSource {
 public:
  SerialSource(SerialAddress address, std::uint32_t baud, int opened)
      : device_(std::move(address.device)),
        parser_(std::move(address.parser)),
        baud_(baud),
        descriptor_(opened) {}
  ~SerialSource() override { leave(); }
  SerialSource(const SerialSource&) = delete;
  SerialSource& operator=(const SerialSource&) = delete;

  [[nodiscard]] Arrival receive(Packet& packet, std::chrono::nanoseconds timeout) override;
  void prepare(const FrameShape& shape) override { parser_->prepare(shape); }
  [[nodiscard]] std::string complaint() const override;
  [[nodiscard]] Counts counts() const override { return {parser_->invalid(), 0, parser_->other()}; }

 private:
  void leave();

  std::string device_;
  static constexpr std::size_t kMostHeard = 1 << 14;

  std::unique_ptr<ByteParser> parser_;
  std::uint32_t baud_;
  int descriptor_;
  std::vector<std::byte> heard_;  ///< the first bytes, for complaint()
};

std::string SerialSource::complaint() const {
  std::string words = parser_->complaint();
  if (!words.ends_with("no packet")) return words;
  if (const auto distance = mark_distance(heard_)) {
    return fmt::format(
        "{}: a FlexiTac board of {} readings? 'serial:{}?protocol=flexitac&rows=ROWS&cols=COLS'",
        words, *distance - FlexitacParser::kMarkBytes, printable(device_));
  }
  const std::string sent = words_on_bytes(heard_);
  return sent.empty() ? words : fmt::format("{}: it sends {}", words, sent);
}

void SerialSource::leave() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
}

Arrival SerialSource::receive(Packet& packet, std::chrono::nanoseconds timeout) {
  for (int reads = 0; !parser_->next(packet); ++reads) {
    if (reads == kMostReads || parser_->is_busy()) return Arrival::timed_out;
    if (descriptor_ < 0) descriptor_ = open_serial_device(device_, baud_);
    if (descriptor_ < 0) {
      std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(timeout, 50ms));
      return Arrival::timed_out;
    }
    const BytesRead read = read_bytes(descriptor_, parser_->space(), timeout);
    if (read.ended) {
      leave();
      parser_->finish();
      if (parser_->next(packet)) break;
      std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(timeout, 50ms));
    }
    if (read.bytes == 0) return Arrival::timed_out;
    if (heard_.size() < kMostHeard) {
      const auto bytes = parser_->space().first(read.bytes);
      heard_.insert(heard_.end(), bytes.begin(), bytes.end());
    }
    parser_->commit(read.bytes, steady_now());
    timeout = 0ns;
  }
  return Arrival::arrived;
}

/// The address of the board that find_board() finds; unset if the user gave up.
std::optional<SerialAddress> found_address(const std::string& pattern,
                                           const LiveSourceOptions& options) {
  const auto board = find_board(pattern, options, [&](const std::string& device) {
    return open_serial_device(device, options.serial_baud);
  });
  if (!board) return std::nullopt;
  const bool is_known =
      options.size && std::size_t{options.size->rows} * options.size->cols == board->readings;
  const std::optional<FrameSize> size = is_known ? options.size : likely_size(board->readings);
  const std::string other =
      fmt::format("'serial:{}?protocol=flexitac&rows=ROWS&cols=COLS'", printable(board->device));
  if (!size) {
    throw Error(printable("serial:" + pattern),
                fmt::format("frames on {} have {} readings, which is no rows x columns",
                            printable(board->device), board->readings),
                "give " + other);
  }
  if (options.say) {
    options.say(fmt::format("found a FlexiTac board on {}, {} readings a frame: {} x {} {}",
                            printable(board->device), board->readings, size->rows, size->cols,
                            is_known ? "as stated" : "is assumed; else give " + other));
  }
  return serial_address(
      fmt::format("{}?protocol=flexitac&rows={}&cols={}", board->device, size->rows, size->cols));
}

std::unique_ptr<FrameStream> open_serial(const std::string& rest,
                                         const LiveSourceOptions& options) {
  const std::string name = printable("serial:" + rest);
  const bool searches = rest == "auto" || rest.find('*') != std::string::npos;
  std::optional<SerialAddress> address =
      searches ? found_address(rest, options) : serial_address(rest);
  if (!address) return nullptr;
  const int opened = open_serial_device(address->device, options.serial_baud);
  if (opened < 0) {
    throw Error(
        name,
        fmt::format("cannot be opened at {} baud: {}", options.serial_baud, std::strerror(errno)),
        "give a serial device that you may read, for instance serial:/dev/ttyACM0");
  }
  return open_packet_stream(
      name, std::make_unique<SerialSource>(std::move(*address), options.serial_baud, opened),
      PacketOrder::kept, options);
}

}  // namespace

LiveSourceKind serial_kind() {
  return {"serial:", "serial:DEVICE[?protocol=flexitac&rows=ROWS&cols=COLS] or serial:auto",
          open_serial};
}

}  // namespace pillarfield
