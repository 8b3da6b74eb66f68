// Packets in a stream of bytes, with rubbish between them.

#include "streams/source/packet_parser.h"

#include <gtest/gtest.h>

#include "tests/streams/source/sent_frames.h"

namespace pillarfield::streams_test {
namespace {

using namespace std::chrono_literals;

constexpr FrameShape kParsed = {SenselType::u8, 18, 14};

/// Feeds bytes in pieces of random length, and calls `found` for each packet.
template <class Found>
std::uint64_t parse(const std::string& bytes, std::mt19937& random, Found found) {
  PacketParser parser;
  Packet packet;
  bool prepared = false;
  const auto take = [&] {
    do {
      while (parser.next(packet)) {
        if (!std::exchange(prepared, true)) parser.prepare(*shape_of(packet.header));
        found(packet);
      }
    } while (parser.is_busy());
  };
  for (std::size_t fed = 0; fed < bytes.size();) {
    const auto space = parser.space();
    const auto size = std::min<std::size_t>({bytes.size() - fed, space.size(), 1 + random() % 200});
    std::memcpy(space.data(), &bytes[fed], size);
    parser.commit(size, 0s);
    fed += size;
    take();
  }
  parser.finish();
  take();
  return parser.invalid();
}

std::string rubbish(std::mt19937& random) {
  std::string bytes(1 + random() % 300, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random());
  // Parts of a magic, and headers of no packet.
  if (random() % 3 == 0) bytes += "PFR";
  if (random() % 3 == 0) bytes += "PFR1" + std::string(80, '\xff');
  if (random() % 5 == 0) bytes += "PFPFR1R1PFR1";
  return bytes;
}

TEST(PacketParser, FindsEveryPacketBetweenRubbish) {
  for (unsigned seed = 0; seed < 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string bytes;
    std::vector<std::uint64_t> sent;
    std::uint64_t runs = 0;
    for (std::uint64_t i = 0; i < 40; ++i) {
      SentPacket packet =
          random() % 2 == 0 ? frame_packet(kParsed, i) : row_packets(kParsed, i, 3)[random() % 3];
      if (random() % 2 == 0) packet = checked(packet);
      const std::uint64_t fate = random() % 8;
      if (fate == 0) {  // cut short by 4 bytes or more
        bytes += packet.bytes().substr(0, 64 + random() % (packet.readings.size() - 3));
        ++runs;
      } else if (fate == 1) {
        runs += bytes.empty() ? 0U : 1U;  // At first it is the rest of a packet.
        bytes += rubbish(random);
      } else if (fate == 2 && (packet.header.content & PILLARFIELD_CHECKED) != 0) {
        packet.readings[random() % packet.readings.size()] ^= 1;
        bytes += packet.bytes();
        ++runs;
      } else {
        bytes += packet.bytes();
        sent.push_back(i);
        continue;
      }
      // Adjacent damage is one run or several; a packet in between makes them count one by one.
      bytes += frame_packet(kParsed, 1000 + i).bytes();
      sent.push_back(1000 + i);
    }
    std::vector<std::uint64_t> received;
    const std::uint64_t invalid = parse(bytes, random, [&](const Packet& packet) {
      received.push_back(packet.header.sequence);
      const std::uint64_t sequence = packet.header.sequence;
      if (content_of(packet.header) == PILLARFIELD_FRAME) {
        EXPECT_EQ(std::memcmp(packet.bytes.data(), readings_of(kParsed, sequence).data(),
                              kParsed.bytes()),
                  0);
      }
    });
    EXPECT_EQ(received, sent);
    EXPECT_EQ(invalid, runs);
  }
}

TEST(PacketParser, ReadingsMayLookLikeAMagic) {
  std::string bytes;
  for (std::uint64_t i = 0; i < 10; ++i) {
    SentPacket packet = frame_packet(kParsed, i);
    for (std::size_t at = 0; at + 4 < packet.readings.size(); at += 4) {
      packet.readings.replace(at, 4, "PFR1");
    }
    bytes += packet.bytes();
  }
  std::mt19937 random(1);
  std::uint64_t received = 0;
  EXPECT_EQ(parse(bytes, random, [&](const Packet&) { ++received; }), 0);
  EXPECT_EQ(received, 10);
}

TEST(PacketParser, ReturnsBetweenChecksums) {
  constexpr FrameShape kLarge = {SenselType::f32, 256, 256};
  constexpr std::size_t kHeaders = 400;
  SentPacket claim = frame_packet(kLarge, 1);
  claim.header.content |= PILLARFIELD_CHECKED;
  claim.header.bytes += 4;
  claim.readings.clear();
  std::string bytes;
  for (std::size_t i = 0; i < kLarge.bytes() / 64 + kHeaders; ++i) bytes += claim.bytes();
  PacketParser parser;
  Packet packet;
  std::size_t busy = 0;
  for (std::size_t fed = 0; fed < bytes.size();) {
    const auto space = parser.space();
    const auto size = std::min(bytes.size() - fed, space.size());
    std::memcpy(space.data(), &bytes[fed], size);
    parser.commit(size, 0s);
    fed += size;
    EXPECT_FALSE(parser.next(packet));
    for (; parser.is_busy(); ++busy) EXPECT_FALSE(parser.next(packet));
  }
  EXPECT_GE(busy, (kHeaders - 20) * kLarge.bytes() / PacketParser::kMostChecked);
}

TEST(PacketParser, AHeaderAloneNeverAllocatesMuch) {
  SentPacket packet = frame_packet(kParsed, 1);
  packet.header.rows = packet.header.cols = 65534;
  packet.header.bytes = 65534U * 65534U;
  EXPECT_FALSE(shape_of(packet.header));
  packet.header.rows = packet.header.cols = 4096;
  packet.header.bytes = 4096U * 4096U;
  EXPECT_TRUE(shape_of(packet.header));
  packet.header.cols = 4097;
  packet.header.bytes = 4096U * 4097U;
  EXPECT_FALSE(shape_of(packet.header));
}

}  // namespace
}  // namespace pillarfield::streams_test
