#include <unistd.h>

#include "pillarfield/error.h"
#include "streams/live_source.h"
#include "streams/source/byte_source.h"
#include "streams/source/packet_parser.h"
#include "streams/source/packet_source.h"

namespace pillarfield {
namespace {

/// Packets on standard input, up to its end.
class StdinSource final : public PacketSource {
 public:
  [[nodiscard]] Arrival receive(Packet& packet, std::chrono::nanoseconds timeout) override;
  void prepare(const FrameShape& shape) override { parser_.prepare(shape); }
  [[nodiscard]] Counts counts() const override { return {parser_.invalid(), 0, parser_.other()}; }
  [[nodiscard]] std::string complaint() const override { return parser_.complaint(); }

 private:
  PacketParser parser_;
  bool ended_ = false;
};

Arrival StdinSource::receive(Packet& packet, std::chrono::nanoseconds timeout) {
  for (int reads = 0; !parser_.next(packet); ++reads) {
    if (ended_ && !parser_.is_busy()) return Arrival::ended;
    if (reads == kMostReads || parser_.is_busy()) return Arrival::timed_out;
    const BytesRead read = read_bytes(STDIN_FILENO, parser_.space(), timeout);
    if (read.bytes == 0 && !read.ended) return Arrival::timed_out;
    parser_.commit(read.bytes, steady_now());
    ended_ = read.ended;
    if (ended_) parser_.finish();
    timeout = std::chrono::nanoseconds(0);
  }
  return Arrival::arrived;
}

std::unique_ptr<FrameStream> open_stdin(const std::string& /*rest*/,
                                        const LiveSourceOptions& options) {
  constexpr const char* kName = "standard input";
  if (isatty(STDIN_FILENO) != 0) {
    throw Error(kName, "is a terminal", "pipe the packets of a driver into it: driver | ... -");
  }
  return open_packet_stream(kName, std::make_unique<StdinSource>(), PacketOrder::kept, options);
}

}  // namespace

LiveSourceKind stdin_kind() { return {"-", "-", open_stdin}; }

}  // namespace pillarfield
