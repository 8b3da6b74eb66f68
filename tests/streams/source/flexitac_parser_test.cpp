// Frames of a FlexiTac board in a stream of bytes that is damaged on its way.

#include "streams/source/flexitac_parser.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "streams/source/serial_search.h"

namespace pillarfield::streams_test {
namespace {

using namespace std::chrono_literals;

constexpr FrameShape kBoard = {SenselType::u8, 12, 11};
const std::string kMarks = "\xAA\x55";

/// Output of a parser.
struct Parsed {
  std::vector<std::string> frames;
  std::vector<std::uint64_t> sequences;
  std::chrono::nanoseconds arrived = 0s;  ///< of the last piece
};

/// Feeds bytes in pieces of random length, a second apart, and appends the frames found.
void feed(FlexitacParser& parser, const std::string& bytes, std::mt19937& random, Parsed& parsed) {
  Packet packet;
  for (std::size_t fed = 0; fed < bytes.size();) {
    const auto space = parser.space();
    const auto size =
        parsed.arrived == 0s
            ? 1
            : std::min<std::size_t>({bytes.size() - fed, space.size(), 1 + random() % 200});
    std::memcpy(space.data(), &bytes[fed], size);
    parser.commit(size, parsed.arrived += 1s);
    fed += size;
    while (parser.next(packet)) {
      ASSERT_EQ(shape_of(packet.header), kBoard);
      ASSERT_TRUE(is_intact(packet));
      const auto* const readings = reinterpret_cast<const char*>(packet.bytes.data());
      parsed.frames.emplace_back(readings, packet.bytes.size());
      parsed.sequences.push_back(packet.header.sequence);
    }
  }
}

/// Readings that differ from those of every other number, and have no marks in them.
std::string quiet_readings(std::uint32_t number) {
  std::string readings(kBoard.bytes(), '\0');
  std::minstd_rand random(number + 1);
  for (char& reading : readings) reading = static_cast<char>(random() >> 8 & 0x7f);
  return readings;
}

/// The next readings of a skin some of which look like marks, and often stand still while others
/// change.
std::string next_readings(std::string readings, std::mt19937& random) {
  const auto change = [&] { return static_cast<char>(random()); };
  if (random() % 3 == 0) std::ranges::generate(readings, change);
  for (int i = 0; i < 3; ++i) readings[random() % readings.size()] = change();
  if (random() % 2 == 0) readings.replace(random() % (readings.size() - 1), 2, kMarks);
  return readings;
}

/// A frame on a line that loses, doubles or flips a byte of it at a random place. Its readings are
/// those that a flip made of them: there is no checksum.
std::string damaged_frame(std::string& readings, std::mt19937& random) {
  std::string frame = kMarks + readings;
  const std::size_t place = random() % frame.size();
  switch (random() % 3) {
    case 0:
      return frame.erase(place, 1);
    case 1:
      return frame.insert(place, 1, frame[place]);
    default:
      frame[place] = static_cast<char>(frame[place] ^ 1 << random() % 8);
      readings = frame.substr(kMarks.size());
      return frame;
  }
}

/// Each frame must have the readings of one that was sent, later than the one before by the
/// difference of their sequences: what was sent in between was counted as lost.
void expect_right_frames(const Parsed& parsed, const std::vector<std::string>& sent) {
  auto next = sent.begin();
  std::uint64_t first = 0;
  for (std::size_t i = 0; i < parsed.frames.size(); ++i) {
    const auto found = std::find(next, sent.end(), parsed.frames[i]);
    ASSERT_NE(found, sent.end()) << "frame " << i << " was never sent";
    const auto number = static_cast<std::uint64_t>(found - sent.begin());
    if (i == 0) first = number - parsed.sequences[0];
    EXPECT_EQ(parsed.sequences[i] + first, number);
    next = found + 1;
  }
}

TEST(FlexitacParser, TakesNoFrameThatWasNotSent) {
  std::size_t sent_in_all = 0;
  std::size_t taken_in_all = 0;
  for (unsigned seed = 0; seed < 300 && !testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::vector<std::string> sent;
    std::string bytes;
    std::string readings(kBoard.bytes(), '\0');
    for (int i = 0; i < 100; ++i) {
      readings = next_readings(readings, random);
      bytes += random() % 20 == 0 ? damaged_frame(readings, random) : kMarks + readings;
      sent.push_back(readings);
    }
    FlexitacParser parser(kBoard);
    Parsed parsed;
    feed(parser, bytes, random, parsed);
    expect_right_frames(parsed, sent);
    sent_in_all += sent.size();
    taken_in_all += parsed.frames.size();
  }
  EXPECT_GT(taken_in_all, sent_in_all / 2);
}

/// Quiet frames `first` to before `end`, marks included.
std::vector<std::string> quiet_frames(std::uint32_t first, std::uint32_t end) {
  std::vector<std::string> frames;
  for (std::uint32_t i = first; i < end; ++i) frames.push_back(kMarks + quiet_readings(i));
  return frames;
}

std::string joined(const std::vector<std::string>& frames) {
  std::string bytes;
  for (const std::string& frame : frames) bytes += frame;
  return bytes;
}

TEST(FlexitacParser, LosesOneFrameForALostReading) {
  std::mt19937 random(1);
  for (std::size_t place = 0; place < kMarks.size() + kBoard.bytes(); ++place) {
    SCOPED_TRACE(place);
    std::vector<std::string> frames = quiet_frames(0, 10);
    frames[5].erase(place, 1);
    FlexitacParser parser(kBoard);
    Parsed parsed;
    feed(parser, quiet_readings(99).substr(40) + joined(frames) + kMarks, random, parsed);
    std::vector<std::string> expected;
    for (std::uint32_t i = 0; i < 10; ++i) {
      // A mark that is damaged does not end the frame before it.
      const bool lost = i == 5 || (i == 4 && place < kMarks.size());
      if (!lost) expected.push_back(quiet_readings(i));
    }
    EXPECT_EQ(parsed.frames, expected);
    EXPECT_EQ(parsed.sequences.back(), 9);
    EXPECT_EQ(parser.invalid(), 1);
  }
}

TEST(FlexitacParser, TakesReadingsThatLookLikeMarksAndStandStill) {
  constexpr std::size_t kMarkAt = 7;
  const std::string still = quiet_readings(99).replace(kMarkAt, 2, kMarks);
  const std::vector<std::string> stills(20, kMarks + still);
  std::mt19937 random(1);
  FlexitacParser parser(kBoard);
  Parsed parsed;
  feed(parser, joined(quiet_frames(0, 10)) + joined(stills) + joined(quiet_frames(10, 16)), random,
       parsed);
  ASSERT_EQ(parsed.frames.size(), 10 + stills.size() + 6 - 1);
  EXPECT_EQ(parsed.frames[10], still);
  EXPECT_EQ(parsed.frames.back(), quiet_readings(14));
  EXPECT_EQ(parser.invalid(), 0);
}

TEST(FlexitacParser, GuessesNothingWhileStillReadingsCanBeReadInTwoWays) {
  std::mt19937 random(1);
  // In the middle of a frame two chains would only change places.
  for (std::size_t mark_at = 0; mark_at < kBoard.bytes() / 2 - 1; ++mark_at) {
    SCOPED_TRACE(mark_at);
    const std::string still = quiet_readings(99).replace(mark_at, 2, kMarks);
    std::vector<std::string> frames = quiet_frames(0, 10);
    frames.insert(frames.end(), 20, kMarks + still);
    const std::vector<std::string> later = quiet_frames(10, 13);
    frames.insert(frames.end(), later.begin(), later.end());
    // So many bytes that what looks like marks then lies where marks are expected.
    std::string bytes = joined(frames);
    bytes.erase(20 * (kMarks.size() + kBoard.bytes()) + 40, kMarks.size() + mark_at);
    FlexitacParser parser(kBoard);
    Parsed parsed;
    feed(parser, bytes + kMarks, random, parsed);
    for (const std::string& frame : parsed.frames) {
      EXPECT_NE(std::ranges::find(frames, kMarks + frame), frames.end());
    }
    EXPECT_GE(parsed.frames.size(), 10 + 10 + 2);
    EXPECT_EQ(parsed.frames.back(), quiet_readings(12));
    EXPECT_GE(parser.invalid(), 1);
  }
}

TEST(FlexitacParser, LeavesReadingsThatItTookForMarks) {
  std::vector<std::string> frames(30, kMarks + quiet_readings(1).replace(27, 2, kMarks));
  frames[1][0] ^= 1;  // So the only marks two of which lie one frame apart are readings.
  std::mt19937 random(1);
  FlexitacParser parser(kBoard);
  Parsed parsed;
  feed(parser, joined(frames), random, parsed);
  EXPECT_LE(parsed.frames.size(), 1);
  feed(parser, joined(quiet_frames(2, 5)) + kMarks, random, parsed);
  EXPECT_EQ(parsed.frames.back(), quiet_readings(4));
}

TEST(FlexitacParser, TakesNoFrameThatLostManyBytes) {
  std::mt19937 random(1);
  std::vector<std::string> sent;
  std::string bytes;
  for (int i = 0; i < 20'000; ++i) {
    std::string frame = kMarks + std::string(kBoard.bytes(), '\0');
    std::generate(frame.begin() + 2, frame.end(), [&] { return static_cast<char>(random()); });
    sent.push_back(frame.substr(kMarks.size()));
    if (i % 5 == 4) frame.erase(random() % 30, 1 + random() % 100);
    bytes += frame;
  }
  FlexitacParser parser(kBoard);
  Parsed parsed;
  feed(parser, bytes, random, parsed);
  EXPECT_GE(parsed.frames.size(), sent.size() * 3 / 5);
  std::ranges::sort(sent);
  for (const std::string& frame : parsed.frames) {
    ASSERT_TRUE(std::ranges::binary_search(sent, frame));
  }
}

TEST(FlexitacParser, CountsTheLastFrameThatNoMarkFollows) {
  std::mt19937 random(1);
  FlexitacParser parser(kBoard);
  Parsed parsed;
  feed(parser, joined(quiet_frames(0, 3)), random, parsed);
  EXPECT_EQ(parsed.frames.size(), 2);
  parser.finish();
  EXPECT_EQ(parser.invalid(), 1);
  feed(parser, joined(quiet_frames(10, 12)), random, parsed);
  EXPECT_EQ(parsed.frames.back(), quiet_readings(10));
  EXPECT_EQ(parsed.sequences, (std::vector<std::uint64_t>{0, 1, 3}));
  EXPECT_EQ(parser.invalid(), 1);
}

TEST(FlexitacParser, AFrameArrivedWithItsLastByte) {
  FlexitacParser parser(kBoard);
  const auto commit = [&](const std::string& bytes, std::chrono::nanoseconds arrived) {
    std::memcpy(parser.space().data(), bytes.data(), bytes.size());
    parser.commit(bytes.size(), arrived);
  };
  Packet packet;
  const std::string frame = kMarks + quiet_readings(1);
  commit(frame.substr(0, 50), 1s);
  commit(frame.substr(50), 2s);
  EXPECT_FALSE(parser.next(packet));
  commit(frame, 9s);
  ASSERT_TRUE(parser.next(packet));
  EXPECT_EQ(packet.arrived, 2s);
}

TEST(FlexitacParser, ABoardOpenedInsideAFrameLosesNothing) {
  std::mt19937 random(1);
  for (int seed = 0; seed < 200; ++seed) {
    // Bytes that waited since before end anywhere, and the line goes on anywhere.
    const std::string waited =
        joined(quiet_frames(0, 1 + static_cast<std::uint32_t>(random() % 9)));
    const std::string bytes = waited.substr(random() % 100, random() % waited.size()) +
                              quiet_readings(99).substr(random() % kBoard.bytes());
    FlexitacParser parser(kBoard);
    std::memcpy(parser.space().data(), bytes.data(), bytes.size());
    parser.commit(bytes.size(), 0s);
    Parsed parsed;
    feed(parser, joined(quiet_frames(20, 30)) + kMarks, random, parsed);
    ASSERT_GE(parsed.frames.size(), 10U);
    EXPECT_EQ(parsed.frames.back(), quiet_readings(29));
    EXPECT_EQ(parser.invalid(), 0U) << seed;
    EXPECT_EQ(parsed.sequences.back(), parsed.sequences.size() - 1) << seed;
  }
}

TEST(FlexitacParser, TellsWhyNoFrameComes) {
  std::mt19937 random(1);
  Parsed parsed;
  FlexitacParser parser(kBoard);
  feed(parser, joined(quiet_frames(0, 20)), random, parsed);
  EXPECT_EQ(parser.complaint(), "");
  FlexitacParser larger({SenselType::u8, 16, 16});
  feed(larger, joined(quiet_frames(0, 20)), random, parsed);
  EXPECT_EQ(larger.complaint(), "frames have 132 readings, 16 x 16 expected");
  FlexitacParser silent(kBoard);
  feed(silent, std::string(5000, '\0'), random, parsed);
  EXPECT_EQ(silent.complaint(),
            "bytes come, but no frames of 12 x 11; check rows, columns and baud rate");
  const std::string still = quiet_readings(1).replace(9, 2, kMarks);
  FlexitacParser doubtful(kBoard);
  feed(doubtful, joined(std::vector<std::string>(20, kMarks + still)), random, parsed);
  EXPECT_EQ(doubtful.complaint(),
            "readings look like the marks of frames; press the skin, so that they change");
}

/// Some readings look like marks: one before the first frame, one in each, one in every third that
/// moves.
TEST(MarkDistance, IsNeverAnyOtherThanThatOfTheFrames) {
  std::string sent = quiet_readings(99).replace(20, 2, kMarks);
  for (std::uint32_t number = 0; number < 12; ++number) {
    std::string readings = quiet_readings(number).replace(10, 2, kMarks);
    if (number % 3 == 0) readings.replace(40 + number, 2, kMarks);
    sent += kMarks + readings;
  }
  const std::size_t distance = kBoard.bytes() + 2;
  for (std::size_t size = 0; size <= sent.size(); ++size) {
    const auto found = mark_distance(std::as_bytes(std::span(sent).first(size)));
    ASSERT_EQ(found.value_or(distance), distance) << "after " << size << " bytes";
    EXPECT_EQ(found.has_value(), size >= 8 * distance) << "after " << size << " bytes";
  }
}

TEST(LikelySize, IsNearestToASquare) {
  for (const auto& [readings, rows, cols] :
       {std::array{384U, 16U, 24U}, {1024U, 32U, 32U}, {1023U, 31U, 33U}, {4U, 2U, 2U}}) {
    const auto size = likely_size(readings);
    ASSERT_TRUE(size.has_value());
    EXPECT_EQ(std::pair(size->rows, size->cols), std::pair(rows, cols));
  }
  for (const std::size_t readings : {0U, 1U, 3U, 97U}) EXPECT_FALSE(likely_size(readings));
}

}  // namespace
}  // namespace pillarfield::streams_test
