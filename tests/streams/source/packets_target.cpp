#include <algorithm>
#include <cstring>
#include <fstream>
#include <memory>
#include <vector>

#include "fuzz/targets.h"
#include "pillarfield/error.h"
#include "streams/source/flexitac_parser.h"
#include "streams/source/frame_assembler.h"
#include "streams/source/packet_parser.h"

namespace pillarfield::fuzz {
namespace {

constexpr std::size_t kPieceBytes = 999;  ///< read from the pipe at a time

std::vector<char> bytes_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// An assembler for the shape of the first packet.
class PacketRun {
 public:
  explicit PacketRun(PacketOrder order) : order_(order) {}

  void add(const Packet& packet) {
    const FrameShape shape = shape_of(packet.header).value();
    if (assembler_ == nullptr) {
      Skin skin;
      skin.rows = shape.rows;
      skin.cols = shape.cols;
      assembler_ = std::make_unique<FrameAssembler>(shape, order_);
      frame_ = std::make_unique<StreamedFrame>(shape.type, skin);
    }
    assembler_->add(packet);
    pop();
  }
  StreamHealth finish() {
    if (assembler_ == nullptr) return {};
    assembler_->give_up();
    pop();
    return assembler_->health(std::chrono::nanoseconds(0));
  }

 private:
  void pop() {
    while (assembler_->pop(*frame_)) {
    }
  }

  PacketOrder order_;
  std::unique_ptr<FrameAssembler> assembler_;
  std::unique_ptr<StreamedFrame> frame_;
};

/// Feeds bytes to a parser as a pipe does; true if they make a frame, and no more than
/// `most_invalid` packets or runs of bytes are invalid.
bool read_all(const std::vector<char>& bytes, ByteParser& parser, std::uint64_t most_invalid) {
  PacketRun in_order(PacketOrder::kept);
  PacketRun in_any_order(PacketOrder::not_kept);
  std::optional<FrameShape> shape;
  std::chrono::nanoseconds now(0);
  Packet packet;
  const auto take_some = [&] {
    while (parser.next(packet)) {
      if (!shape) parser.prepare(*(shape = shape_of(packet.header)));
      if (std::size_t{shape->rows} * shape->cols > kMaxRead) continue;
      packet.arrived = now += std::chrono::milliseconds(1);
      in_order.add(packet);
      in_any_order.add(packet);
    }
  };
  const auto take = [&] {
    do {
      take_some();
    } while (parser.is_busy());
  };
  for (std::size_t fed = 0; fed < bytes.size();) {
    const auto space = parser.space();
    const std::size_t size = std::min({space.size(), bytes.size() - fed, kPieceBytes});
    std::memcpy(space.data(), &bytes[fed], size);
    parser.commit(size, now);
    fed += size;
    take();
  }
  parser.finish();
  take();
  const StreamHealth health = in_order.finish();
  in_any_order.finish();
  return health.frames > 0 && health.invalid + parser.invalid() <= most_invalid;
}

}  // namespace

void read_packets(const std::filesystem::path& path, [[maybe_unused]] const ReadOptions& options) {
  const std::vector<char> bytes = bytes_of_file(path);
  PacketParser packets;
  FlexitacParser frames({SenselType::u8, 5, 7});
  const bool are_packets = read_all(bytes, packets, 0);
  const bool are_frames = read_all(bytes, frames, 1);  // the last one, which nothing follows
  if (!are_packets && !are_frames) {
    throw Error(path.native(), "holds bytes that are not packets", "docs/stream_format.md");
  }
}

}  // namespace pillarfield::fuzz
