#pragma once

#include <gtest/gtest.h>

#include "streams/source/frame_assembler.h"
#include "tests/streams/source/damage_plan.h"

namespace pillarfield::streams_test {

using namespace std::chrono_literals;

/// A packet as the assembler takes it; `sent` must outlive it.
inline Packet received(const SentPacket& sent, std::chrono::nanoseconds arrived) {
  return {sent.header, std::as_bytes(std::span(sent.readings)), arrived};
}

/// Compares the counts that packets determine.
inline void expect_counts(const StreamHealth& health, const StreamHealth& expected) {
  EXPECT_EQ(health.frames, expected.frames);
  EXPECT_EQ(health.lost, expected.lost);
  EXPECT_EQ(health.incomplete, expected.incomplete);
  EXPECT_EQ(health.late, expected.late);
  EXPECT_EQ(health.duplicates, expected.duplicates);
  EXPECT_EQ(health.reordered, expected.reordered);
  EXPECT_EQ(health.invalid, expected.invalid);
  EXPECT_EQ(health.restarts, expected.restarts);
  EXPECT_EQ(health.clock_jumps, expected.clock_jumps);
}

/// Checks frames of rows, in the order in which they are delivered, against the packets that came.
class FrameCheck {
 public:
  FrameCheck(const FrameShape& shape, const Expected& expected)
      : shape_(shape), expected_(expected), readings_(shape.bytes(), '\0') {}

  void operator()(const StreamedFrame& frame) {
    const auto found = expected_.frames.find(frame.sequence);
    ASSERT_NE(found, expected_.frames.end()) << "frame " << frame.sequence;
    ASSERT_TRUE(last_ < 0 || frame.sequence > static_cast<std::uint64_t>(last_));
    last_ = static_cast<std::int64_t>(frame.sequence);
    std::vector<bool> came(shape_.rows, false);
    for (const SentPacket& packet : found->second) {
      readings_.replace(packet.header.first * shape_.row_bytes(), packet.readings.size(),
                        packet.readings);
      std::fill_n(came.begin() + packet.header.first, packet.header.count, true);
    }
    for (const SenselBlock& block : frame.missing) {
      EXPECT_EQ(block.cols, shape_.cols);
      for (std::uint32_t row = 0; row < block.rows; ++row) {
        EXPECT_FALSE(came[block.first_row + row]);
        came[block.first_row + row] = true;
      }
    }
    EXPECT_EQ(std::ranges::count(came, false), 0) << "frame " << frame.sequence;
    ASSERT_EQ(std::memcmp(frame.readings.data, readings_.data(), readings_.size()), 0)
        << "frame " << frame.sequence;
    EXPECT_GT(frame.time_s, time_s_);
    time_s_ = frame.time_s;
  }

 private:
  FrameShape shape_;
  const Expected& expected_;
  std::string readings_;
  std::int64_t last_ = -1;
  double time_s_ = -1;
};

/// An assembler, and the frames that it delivered.
struct AssemblerRun {
  explicit AssemblerRun(const FrameShape& frame_shape, PacketOrder order = PacketOrder::not_kept)
      : shape(frame_shape), assembler(shape, order), frame(shape.type, skin_of(shape)) {}

  static Skin skin_of(const FrameShape& shape) {
    Skin skin;
    skin.rows = shape.rows;
    skin.cols = shape.cols;
    return skin;
  }

  void add(const SentPacket& packet, std::chrono::nanoseconds later = 1ms) {
    now += later;
    assembler.add(received(packet, now));
    pop();
  }
  void pop() {
    while (assembler.pop(frame)) {
      sequences.push_back(frame.sequence);
      times_s.push_back(frame.time_s);
      missing.push_back(frame.missing.size());
      const auto bytes = frame.buffer.bytes();
      readings.emplace_back(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    }
  }
  [[nodiscard]] StreamHealth health() const { return assembler.health(now); }

  FrameShape shape;
  FrameAssembler assembler;
  StreamedFrame frame;
  std::chrono::nanoseconds now{1s};
  std::vector<std::uint64_t> sequences;
  std::vector<double> times_s;
  std::vector<std::size_t> missing;
  std::vector<std::string> readings;
};

}  // namespace pillarfield::streams_test
