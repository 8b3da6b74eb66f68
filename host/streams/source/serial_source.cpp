// Not termios.h, which knows only some baud rates and contradicts this header.
#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/printable.h"
#include "streams/live_source.h"
#include "streams/source/byte_source.h"
#include "streams/source/packet_source.h"
#include "streams/source/serial_address.h"

namespace pillarfield {
namespace {

using namespace std::chrono_literals;

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
  std::unique_ptr<ByteParser> parser_;
  std::uint32_t baud_;
  int descriptor_;
};

std::string SerialSource::complaint() const {
  std::string words = parser_->complaint();
  if (!words.ends_with("no packet")) return words;
  return fmt::format("{}: a FlexiTac board? 'serial:{}?protocol=flexitac&rows=ROWS&cols=COLS'",
                     words, printable(device_));
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
    parser_->commit(read.bytes, steady_now());
    timeout = 0ns;
  }
  return Arrival::arrived;
}

std::unique_ptr<FrameStream> open_serial(const std::string& rest,
                                         const LiveSourceOptions& options) {
  const std::string name = printable("serial:" + rest);
  SerialAddress address = serial_address(rest);
  const int opened = open_serial_device(address.device, options.serial_baud);
  if (opened < 0) {
    throw Error(
        name,
        fmt::format("cannot be opened at {} baud: {}", options.serial_baud, std::strerror(errno)),
        "give a serial device that you may read, for instance serial:/dev/ttyACM0");
  }
  return open_packet_stream(
      name, std::make_unique<SerialSource>(std::move(address), options.serial_baud, opened),
      PacketOrder::kept, options);
}

}  // namespace

LiveSourceKind serial_kind() {
  return {"serial:", "serial:DEVICE[?protocol=flexitac&rows=ROWS&cols=COLS]", open_serial};
}

}  // namespace pillarfield
