// Packets to frames: random plans of damage with exact counts, contents, restarts, clocks.

#include "streams/source/frame_assembler.h"

#include <gtest/gtest.h>

#include "tests/pipeline/allocation_count.h"
#include "tests/streams/source/assembler_run.h"

namespace pillarfield::streams_test {
namespace {

constexpr FrameShape kShape = {SenselType::u16, 20, 12};

using Sequences = std::vector<std::uint64_t>;

/// Runs a plan; returns the counts that it must have.
StreamHealth run_plan(unsigned seed, PacketOrder order) {
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  const auto parts = static_cast<std::uint32_t>(1 + random() % 5);
  std::vector<std::vector<SentPacket>> frames;
  for (std::uint64_t i = 0; i < 60; ++i) frames.push_back(row_packets(kShape, 100 + i, parts));
  if (random() % 2 == 0) {
    for (auto& frame : frames) std::ranges::transform(frame, frame.begin(), checked);
  }
  const auto arriving = damage(frames, random, order == PacketOrder::not_kept);
  Expected expected = expect(arriving, static_cast<std::uint64_t>(order));
  for (auto& [sequence, packets] : expected.frames) {
    for (SentPacket& packet : packets) {
      packet.readings.resize(packet.header.count * kShape.row_bytes());  // without checksum
    }
  }
  FrameCheck check(kShape, expected);
  AssemblerRun run(kShape, order);
  for (const SentPacket& packet : arriving) {
    run.now += 1ms;
    run.assembler.add(received(packet, run.now));
    while (run.assembler.pop(run.frame)) check(run.frame);
  }
  run.assembler.give_up();
  while (run.assembler.pop(run.frame)) check(run.frame);
  expect_counts(run.health(), expected.health);
  return expected.health;
}

TEST(FrameAssembler, CountsEveryDamageOfAPlan) {
  for (const PacketOrder order : {PacketOrder::not_kept, PacketOrder::kept}) {
    StreamHealth all;
    for (unsigned seed = 0; seed < 300 && !testing::Test::HasFailure(); ++seed) {
      const StreamHealth health = run_plan(seed, order);
      for (const auto count :
           {&StreamHealth::lost, &StreamHealth::incomplete, &StreamHealth::late,
            &StreamHealth::duplicates, &StreamHealth::reordered, &StreamHealth::invalid}) {
        all.*count += health.*count;
      }
    }
    EXPECT_GT(std::min({all.lost, all.incomplete, all.duplicates, all.invalid}), 20);
    if (order == PacketOrder::not_kept) {
      EXPECT_GT(std::min(all.late, all.reordered), 20);
    }
  }
}

TEST(FrameAssembler, DeliversAWholeFrameAtOnce) {
  for (const SenselType type : {SenselType::u8, SenselType::u16, SenselType::f32}) {
    const FrameShape shape = {type, 9, 7};
    AssemblerRun run(shape);
    run.add(frame_packet(shape, 5));
    run.add(checked(frame_packet(shape, 6)));
    EXPECT_EQ(run.sequences, (Sequences{5, 6}));
    EXPECT_EQ(run.readings[0], readings_of(shape, 5));
    EXPECT_EQ(run.readings[1], readings_of(shape, 6));
  }
}

TEST(FrameAssembler, GivesUpAfterTwoIntervalsWithoutAPacket) {
  AssemblerRun run(kShape);
  for (std::uint64_t i = 0; i < 20; ++i) run.add(frame_packet(kShape, i), 50ms);
  EXPECT_FALSE(run.assembler.deadline());
  run.add(row_packets(kShape, 20, 2)[0], 50ms);
  ASSERT_TRUE(run.assembler.deadline());
  EXPECT_NEAR(std::chrono::duration<double>(*run.assembler.deadline() - run.now).count(), 0.1,
              0.001);
  run.assembler.give_up();
  run.pop();
  EXPECT_EQ(run.sequences.back(), 20);
  EXPECT_EQ(run.missing.back(), 1);
  run.add(row_packets(kShape, 20, 2)[1]);
  EXPECT_EQ(run.health().late, 1);
  EXPECT_EQ(run.health().incomplete, 1);
}

TEST(FrameAssembler, DoesNotCountTheFrameInWhoseMiddleItStarts) {
  AssemblerRun run(kShape);
  run.add(row_packets(kShape, 4, 3)[2]);
  run.add(frame_packet(kShape, 5));
  run.add(frame_packet(kShape, 6));
  EXPECT_EQ(run.sequences, (Sequences{5, 6}));
  expect_counts(run.health(), {.frames = 2});
}

TEST(FrameAssembler, FollowsANewSession) {
  AssemblerRun run(kShape);
  for (std::uint64_t i = 50; i < 53; ++i) run.add(frame_packet(kShape, i));
  SentPacket packet = frame_packet(kShape, 51);
  packet.header.session = 8;
  packet.header.time_ns = 3;
  run.add(packet, 20ms);
  packet.header.sequence = 52;
  packet.header.time_ns = 4'000'003;
  run.add(packet);
  run.add(frame_packet(kShape, 53));  // of the session that was replaced
  EXPECT_EQ(run.sequences, (Sequences{50, 51, 52, 51, 52}));
  expect_counts(run.health(), {.frames = 5, .late = 1, .restarts = 1});
  ASSERT_EQ(run.times_s.size(), 5);
  EXPECT_NEAR(run.times_s[3] - run.times_s[2], 0.020, 1e-9);  // arrivals across the restart
  EXPECT_NEAR(run.times_s[4] - run.times_s[3], 0.004, 1e-9);
}

TEST(FrameAssembler, AReplacedSessionCountsAgainAfterASecondOfSilence) {
  AssemblerRun run(kShape);
  run.add(frame_packet(kShape, 5));
  SentPacket other = frame_packet(kShape, 100);
  other.header.session = 8;
  run.add(other);
  run.add(frame_packet(kShape, 6), 990ms);
  EXPECT_EQ(run.health().late, 1);
  run.add(frame_packet(kShape, 7), 20ms);
  EXPECT_EQ(run.sequences, (Sequences{5, 100, 7}));
  EXPECT_EQ(run.health().restarts, 2);
}

TEST(FrameAssembler, FollowsASequenceThatBeginsAnew) {
  struct Case {
    std::uint64_t last, next;
    std::chrono::nanoseconds pause;
    bool restarts;
  };
  for (const Case& each :
       {Case{100, 0, 1ms, true}, Case{100, 20, 1ms, false}, Case{5000, 3000, 1ms, true},
        Case{20, 0, 1ms, false}, Case{20, 0, 600ms, true}, Case{20, 5'000'000, 1ms, true}}) {
    SCOPED_TRACE(each.next);
    AssemblerRun run(kShape);
    run.add(frame_packet(kShape, each.last));
    run.add(frame_packet(kShape, each.next), each.pause);
    EXPECT_EQ(run.sequences.size(), each.restarts ? 2 : 1);
    EXPECT_EQ(run.health().restarts, each.restarts ? 1 : 0);
    EXPECT_EQ(run.health().late, each.restarts ? 0 : 1);
    EXPECT_EQ(run.health().lost, 0);
  }
}

TEST(FrameAssembler, EndDeliversWhatCameAndAllowsARestart) {
  AssemblerRun run(kShape);
  run.add(frame_packet(kShape, 3));
  run.add(row_packets(kShape, 4, 2)[0]);
  SentPacket end = {header_of(kShape, 4), {}};
  end.header.content = PILLARFIELD_END;
  run.add(end);
  EXPECT_EQ(run.sequences, (Sequences{3, 4}));
  run.add(frame_packet(kShape, 3));
  EXPECT_EQ(run.sequences, (Sequences{3, 4, 3}));
  expect_counts(run.health(), {.frames = 3, .incomplete = 1, .restarts = 1});
}

TEST(FrameAssembler, TheLastSequenceNumberIsInvalidSinceNoneCanFollow) {
  AssemblerRun run(kShape);
  run.add(frame_packet(kShape, 3));
  run.add(frame_packet(kShape, ~std::uint64_t{0}));
  run.add(frame_packet(kShape, 4));
  for (std::uint64_t i = 100; i < 1000; i += 100) run.add(row_packets(kShape, i, 2)[0]);
  EXPECT_EQ(run.health().invalid, 1);
  EXPECT_LT(run.health().lost, 1000);
}

TEST(FrameAssembler, TimeNeverGoesBack) {
  AssemblerRun run(kShape);
  std::uint64_t sequence = 0;
  const auto send = [&](std::uint64_t time_ns) {
    SentPacket packet = frame_packet(kShape, sequence++);
    packet.header.time_ns = time_ns;
    run.add(packet, 10ms);
  };
  for (const std::uint64_t time_ns :
       {std::uint64_t{9'000'000'000}, std::uint64_t{9'008'000'000},  // 8 ms
        std::uint64_t{2'000'000'000}, std::uint64_t{2'012'000'000},  // back: the arrivals' 10 ms
        std::uint64_t{3'013'000'000},                                // ahead by 1.001 s
        std::uint64_t{3'900'000'000},                                // by 0.887 s
        ~std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{0}}) {    // no clock any more
    send(time_ns);
  }
  EXPECT_EQ(run.health().clock_jumps, 3);
  const std::vector<double> expected = {0, 0.008, 0.018, 0.030, 1.031, 1.918, 1.928, 1.938, 1.948};
  ASSERT_EQ(run.times_s.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(run.times_s[i], expected[i], 1e-9);
}

TEST(FrameAssembler, AllocatesNothingForAFrame) {
  std::vector<SentPacket> packets;
  for (std::uint64_t i = 0; i < 50; ++i) {
    packets.push_back(frame_packet(kShape, 3 * i));
    packets.push_back(row_packets(kShape, 3 * i + 1, 20)[7]);
    packets.push_back(row_packets(kShape, 3 * i + 2, 2)[1]);
  }
  FrameAssembler assembler(kShape, PacketOrder::not_kept);
  StreamedFrame frame(kShape.type, AssemblerRun::skin_of(kShape));
  std::uint64_t before = 0;
  for (std::size_t i = 0; i < packets.size(); ++i) {
    if (i == 20) before = pipeline_test::allocations();  // The frame has its memory by now.
    assembler.add(received(packets[i], std::chrono::milliseconds(i)));
    while (assembler.pop(frame)) {
    }
  }
  EXPECT_EQ(pipeline_test::allocations(), before);
}

TEST(FrameAssembler, RateIsThatOfTheLastSecond) {
  AssemblerRun run(kShape);
  EXPECT_EQ(run.health().rate_hz, 0);
  for (std::uint64_t i = 0; i < 3000; ++i) run.add(frame_packet(kShape, i), 2ms);
  EXPECT_NEAR(run.health().rate_hz, 500, 5);
  for (std::uint64_t i = 3000; i < 3120; ++i) run.add(frame_packet(kShape, i), 10ms);
  EXPECT_NEAR(run.health().rate_hz, 100, 2);
  run.now += 5s;
  EXPECT_EQ(run.health().rate_hz, 0);
}

}  // namespace
}  // namespace pillarfield::streams_test
