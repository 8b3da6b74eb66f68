#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "pillarfield/live.h"
#include "streams/source/frame_assembler.h"
#include "streams/source/packet.h"

namespace pillarfield {

[[nodiscard]] inline std::chrono::nanoseconds steady_now() {
  return std::chrono::steady_clock::now().time_since_epoch();
}

/// A source of packets.
class PacketSource {
 public:
  PacketSource() = default;
  virtual ~PacketSource() = default;
  PacketSource(const PacketSource&) = delete;
  PacketSource& operator=(const PacketSource&) = delete;

  /// Waits for a packet, at most for `timeout`, and may return earlier. The packet is not checked.
  [[nodiscard]] virtual Arrival receive(Packet& packet, std::chrono::nanoseconds timeout) = 0;

  /// The constants of the skin that the packet received last states.
  [[nodiscard]] virtual StoredSkin stated(const Packet& packet) const {
    return stated_by(packet.header);
  }

  /// Allocates the memory for frames of this shape; the last packet received stays valid.
  virtual void prepare(const FrameShape& /*shape*/) {}

  /// True if anyone may send to it: then frames of another size need not be the sensor's.
  [[nodiscard]] virtual bool is_open_to_all() const { return false; }

  /// Reason why bytes but no packet came, for the user who waits; empty: unknown.
  [[nodiscard]] virtual std::string complaint() const { return {}; }

  /// Counts since the source was opened.
  struct Counts {
    std::uint64_t invalid = 0;             ///< no packets
    std::uint64_t overrun = 0;             ///< packets lost because nobody received them in time
    std::optional<FrameShape> other = {};  ///< of frames refused since prepare(), the latest
  };
  [[nodiscard]] virtual Counts counts() const = 0;
};

/// Opens a stream of the frames of a source: waits for its first frame. Null if options.stop gave
/// up. Throws Error, naming `name`, if the source ends before, or calibration or size do not fit.
[[nodiscard]] std::unique_ptr<FrameStream> open_packet_stream(const std::string& name,
                                                              std::unique_ptr<PacketSource> source,
                                                              PacketOrder order,
                                                              const LiveSourceOptions& options);

}  // namespace pillarfield
