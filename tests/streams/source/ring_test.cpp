// Rings in shared memory: readers and writers in processes that are killed, hostile segments.

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <thread>

#include "pillarfield/error.h"
#include "streams/ring/ring_reader.h"
#include "streams/ring/ring_writer.h"
#include "tests/base/message.h"
#include "tests/streams/source/source_run.h"

namespace pillarfield::streams_test {
namespace {

using core_test::message_of;

constexpr FrameShape kShape = {SenselType::u8, 40, 30};
constexpr RingLayout kLayout = {PILLARFIELD_RING_FRAMES, 40, 30, PILLARFIELD_U8};

/// A name that no other run has; the segment is unlinked at the end.
class Name {
 public:
  Name()
      : text_("pillarfield-test-" + std::to_string(getpid()) + "-" + std::to_string(++count())) {}
  ~Name() { shm_unlink(("/" + text_).c_str()); }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] std::string source() const { return "shm:" + text_; }
  [[nodiscard]] bool exists() const { return std::filesystem::exists("/dev/shm/" + text_); }

 private:
  static int& count() {
    static int value = 0;
    return value;
  }
  std::string text_;
};

/// Message with which opening the source is refused.
std::string refusal_of(const std::string& source) {
  return message_of([&] { (void)open_live_source(source, {.stop = [] { return true; }}); });
}

bool publish(RingWriter& writer, const SentPacket& packet) {
  std::byte* const slot = writer.begin().data();
  auto& head = *reinterpret_cast<PillarfieldFrameSlot*>(slot);
  head.packet = packet.header;
  std::memcpy(slot + sizeof head, packet.readings.data(), packet.readings.size());
  return writer.publish();
}

/// A child process, killed at the end.
class Child {
 public:
  template <class Action>
  explicit Child(Action action) : id_(fork()) {
    if (id_ != 0) return;
    action();
    _exit(0);
  }
  ~Child() { stop(SIGKILL); }
  /// Sends the signal and waits; the status of waitpid().
  int stop(int signal) {
    int status = 0;
    if (id_ <= 0) return status;
    kill(id_, signal);
    waitpid(id_, &status, 0);
    id_ = -1;
    return status;
  }
  int wait() {
    int status = 0;
    waitpid(id_, &status, 0);
    id_ = -1;
    return status;
  }

 private:
  pid_t id_;
};

TEST(Ring, ARelayCarriesTheConstantsOfTheSkin) {
  const Name name;
  LiveSinkInfo info;
  info.skin.rows = kShape.rows;
  info.skin.cols = kShape.cols;
  info.skin.layout = SkinLayout::sensels;
  info.skin.sensel_pitch_mm = 5.08;
  info.skin.threshold_counts = 3;
  info.skin.full_scale_counts = 250;
  info.skin.falling = true;
  const auto relay = create_live_relay(name.source(), info);
  const FrameBuffer frame(kShape.type, kShape.rows, kShape.cols);
  relay->append({.readings = frame.view()});
  // The frames are mirrored already.
  const auto stream = open_live_source(name.source(), {.read = {.falling = true}});
  const Skin& skin = stream->skin();
  EXPECT_EQ(skin.layout, SkinLayout::sensels);
  EXPECT_EQ(skin.sensel_pitch_mm, 5.08);
  EXPECT_FALSE(skin.states_counts_per_newton());  // It was assumed.
  EXPECT_EQ(skin.threshold_counts, 3);
  EXPECT_EQ(skin.full_scale_counts, 250);
  EXPECT_TRUE(skin.falling);
  StreamedFrame got(stream->sensel_type(), skin);
  ASSERT_EQ(stream->next(got, std::chrono::seconds(60)), Arrival::arrived);
  EXPECT_EQ(std::ranges::count(got.buffer.bytes(), std::byte{0}), std::ssize(got.buffer.bytes()));
}

TEST(Ring, DeliversFramesAndUnlinksAtTheEnd) {
  const Name name;
  {
    RingWriter writer(name.text(), kLayout, 8);
    publish(writer, frame_packet(kShape, 3));
    publish(writer, frame_packet(kShape, 4));
    const auto stream = open_live_source(name.source(), {});
    const auto other = open_live_source(name.source(), {});
    std::vector<std::string> received;
    const auto take = [&](const StreamedFrame& frame) { received.push_back(bytes_of(frame)); };
    take_frames(*stream, 5ms, take);
    publish(writer, frame_packet(kShape, 5));
    take_frames(*stream, 5ms, take);
    EXPECT_EQ(received, (std::vector{readings_of(kShape, 4), readings_of(kShape, 5)}));
    take_frames(*other, 5ms, [&](const StreamedFrame& frame) {
      EXPECT_EQ(bytes_of(frame), readings_of(kShape, frame.sequence));
    });
    EXPECT_GE(other->health().frames, 1);
    for (std::uint64_t i = 6; i < 40; ++i) publish(writer, frame_packet(kShape, i));
    take_frames(*stream, 5ms, take);
    EXPECT_EQ(received.back(), readings_of(kShape, 39));
    ASSERT_EQ(received.size(), 3);  // A reader that fell behind goes on with the newest.
    expect_counts(stream->health(), {.frames = 3, .lost = 33});
    EXPECT_EQ(stream->health().overrun, 33);
    EXPECT_TRUE(name.exists());
  }
  EXPECT_FALSE(name.exists());
}

TEST(Ring, WakesItsReader) {
  const Name name;
  RingWriter writer(name.text(), kLayout, 8);
  RingReader reader(name.text(), RingReader::Content::frames);
  std::atomic<bool> read = false;
  std::thread waiting([&] { read = reader.read(300s) != nullptr; });
  std::this_thread::sleep_for(20ms);
  publish(writer, frame_packet(kShape, 0));
  waiting.join();
  EXPECT_TRUE(read);
}

TEST(Ring, IsWaitedFor) {
  const Name name;
  std::optional<RingWriter> writer;
  int asked = 0;
  const auto stream = open_live_source(name.source(), {.stop = [&] {
                                         if (++asked == 2) {
                                           writer.emplace(name.text(), kLayout, 4);
                                           publish(*writer, frame_packet(kShape, 0));
                                         }
                                         return asked > 50;
                                       }});
  EXPECT_NE(stream, nullptr);
}

/// Reads frames until `last` comes or 300 s pass; each must be one that was sent.
std::uint64_t read_until(FrameStream& stream, std::uint64_t last) {
  StreamedFrame frame(stream.sensel_type(), stream.skin());
  std::uint64_t received = 0;
  const auto until = std::chrono::steady_clock::now() + 300s;
  while (std::chrono::steady_clock::now() < until) {
    if (stream.next(frame, 10ms) != Arrival::arrived) continue;
    EXPECT_EQ(bytes_of(frame), readings_of(kShape, frame.sequence)) << "a torn frame";
    ++received;
    if (frame.sequence == last) return received;
  }
  ADD_FAILURE() << "frame " << last << " did not come";
  return received;
}

/// Publishes frames from `first` on, as fast as it can, until it is killed.
void write_for_ever(const std::string& name, std::uint64_t session, std::uint64_t first) {
  RingWriter writer(name, kLayout, 4);
  for (std::uint64_t i = first;; ++i) {
    SentPacket packet = frame_packet(kShape, i % 1000 + 1000);
    packet.header.session = session;
    publish(writer, packet);
  }
}

TEST(Ring, SurvivesKilledWriters) {
  const Name name;
  auto first = std::make_optional<Child>([&] { write_for_ever(name.text(), 1, 0); });
  const auto stream = open_live_source(name.source(), {});
  std::mt19937 random(1);
  StreamedFrame frame(stream->sensel_type(), stream->skin());
  for (std::uint64_t round = 0; round < 100; ++round) {
    const auto until =
        std::chrono::steady_clock::now() + std::chrono::microseconds(random() % 3000);
    do {
      if (stream->next(frame, 100us) != Arrival::arrived) continue;
      ASSERT_EQ(bytes_of(frame), readings_of(kShape, frame.sequence)) << "a torn frame";
    } while (std::chrono::steady_clock::now() < until);
    first.emplace([&] { write_for_ever(name.text(), round + 2, 0); });
  }
  first.reset();
  RingWriter writer(name.text(), kLayout, 4);
  SentPacket packet = frame_packet(kShape, 7);
  packet.header.session = 1000;
  publish(writer, packet);
  EXPECT_GT(read_until(*stream, 7), 0);
  EXPECT_GT(stream->health().restarts, 0);  // On a busy computer many writers are killed early.
}

TEST(Ring, SurvivesKilledReaders) {
  const Name name;
  RingWriter writer(name.text(), kLayout, 4);
  publish(writer, frame_packet(kShape, 0));
  std::mt19937 random(1);
  for (std::uint64_t round = 0; round < 100; ++round) {
    Child reader([&] {
      const auto stream = open_live_source(name.source(), {});
      read_until(*stream, 100'000);
    });
    for (std::uint64_t i = 0; i < 20; ++i) {
      publish(writer, frame_packet(kShape, round * 20 + i));
      if (random() % 8 == 0) std::this_thread::sleep_for(100us);
    }
    reader.stop(SIGKILL);
  }
  Child last([&] {
    const auto stream = open_live_source(name.source(), {});
    read_until(*stream, 50'000);
    _exit(testing::Test::HasFailure() ? 1 : 0);
  });
  for (int i = 0; i < 100; ++i) {
    publish(writer, frame_packet(kShape, 50'000));
    std::this_thread::sleep_for(1ms);
  }
  EXPECT_EQ(last.wait(), 0);
}

TEST(Ring, FollowsOneThatReplacesIt) {
  const Name name;
  auto writer = std::make_optional<RingWriter>(name.text(), kLayout, 4);
  publish(*writer, frame_packet(kShape, 5));
  const auto stream = open_live_source(name.source(), {});
  EXPECT_EQ(read_until(*stream, 5), 1);
  writer.reset();
  writer.emplace(name.text(), RingLayout{PILLARFIELD_RING_FRAMES, 40, 31, PILLARFIELD_U8}, 4);
  take_frames(*stream, 120ms, [](auto&) { ADD_FAILURE() << "a frame of another size"; });
  EXPECT_EQ(stream->health().invalid, 1);
  EXPECT_EQ(stream->health().mismatch, "frames are 40 x 31, 40 x 30 expected");
  writer.reset();
  writer.emplace(name.text(), kLayout, 16);
  SentPacket packet = frame_packet(kShape, 1);
  packet.header.session = 9;
  publish(*writer, packet);
  EXPECT_EQ(read_until(*stream, 1), 1);
  expect_counts(stream->health(), {.frames = 2, .invalid = 1, .restarts = 1});
}

TEST(Ring, APollingReaderFollowsOneThatReplacesItToo) {
  const Name name;
  auto writer = std::make_optional<RingWriter>(name.text(), kLayout, 4);
  publish(*writer, frame_packet(kShape, 5));
  const auto stream = open_live_source(name.source(), {});
  StreamedFrame frame(stream->sensel_type(), stream->skin());
  EXPECT_EQ(stream->next(frame, 0ns), Arrival::arrived);
  writer.reset();
  writer.emplace(name.text(), kLayout, 4);
  SentPacket packet = frame_packet(kShape, 1);
  packet.header.session = 9;
  publish(*writer, packet);
  bool arrived = false;
  for (int i = 0; i < 300'000 && !arrived; ++i) {
    arrived = stream->next(frame, 0ns) == Arrival::arrived;
    if (!arrived) std::this_thread::sleep_for(1ms);
  }
  EXPECT_TRUE(arrived);
}

TEST(Ring, RefusesOneOfAnotherKind) {
  const Name name;
  const RingWriter writer(name.text(), {PILLARFIELD_RING_RESULTS, 9, 9, 0, 1}, 4);
  EXPECT_NE(refusal_of(name.source()).find("it holds results, not frames"), std::string::npos);
}

/// A segment that the test writes as it likes.
class Segment {
 public:
  Segment(const Name& name, std::uint64_t bytes)
      : segment_(shm_open(("/" + name.text()).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    resize(bytes);
  }
  void resize(std::uint64_t bytes) {
    ASSERT_EQ(ftruncate(segment_.get(), static_cast<off_t>(bytes)), 0);
  }
  template <class T>
  void put(std::uint64_t offset, const T& value) {
    ASSERT_EQ(pwrite(segment_.get(), &value, sizeof value, static_cast<off_t>(offset)),
              static_cast<ssize_t>(sizeof value));
  }

 private:
  Descriptor segment_;
};

PillarfieldRing ring_of_frames() {
  PillarfieldRing ring = {};
  ring.magic = PILLARFIELD_RING_MAGIC;
  ring.kind = PILLARFIELD_RING_FRAMES;
  ring.rows = kShape.rows;
  ring.cols = kShape.cols;
  ring.type = PILLARFIELD_U8;
  ring.slots = 4;
  ring.slot_bytes = 1344;
  return ring;
}

TEST(HostileRing, LyingSizesAreRefused) {
  std::mt19937_64 random(1);
  using Lie = void (*)(PillarfieldRing & ring, std::uint64_t any);
  const Lie lies[] = {
      [](auto& ring, auto any) { ring.slots = static_cast<std::uint32_t>(5 + any % 100); },
      [](auto& ring, auto any) { ring.slot_bytes = 64 * (22 + any % 1000); },
      [](auto& ring, auto any) { ring.slot_bytes = any % 1328; },
      [](auto& ring, auto any) { ring.rows = static_cast<std::uint32_t>(any | 64); },
      [](auto& ring, auto any) { ring.cols = static_cast<std::uint32_t>(any | 64); },
      [](auto& ring, auto) { ring.slots = 0; }};
  for (int round = 0; round < 200; ++round) {
    const Name name;
    Segment segment(name, 64 + 4 * 1344);
    PillarfieldRing ring = ring_of_frames();
    lies[round % 6](ring, random());
    segment.put(0, ring);
    EXPECT_NE(refusal_of(name.source()).find("not a ring of frames"), std::string::npos);
  }
}

/// A ring whose reader has its first frame, and which then turns hostile.
class TurnedRing : public testing::Test {
 protected:
  TurnedRing() {
    ring_.published = 1;
    slot_.lock = 2;
    slot_.packet = frame_packet(kShape, 0).header;
    segment_.put(64, slot_);
    segment_.put(0, ring_);
    stream_ = open_live_source(name_.source(), {});
    frame_.emplace(stream_->sensel_type(), stream_->skin());
    EXPECT_EQ(stream_->next(*frame_, 10ms), Arrival::arrived);
  }

  Name name_;
  Segment segment_{name_, 64 + 4 * 1344};
  PillarfieldRing ring_ = ring_of_frames();
  PillarfieldFrameSlot slot_ = {};
  std::unique_ptr<FrameStream> stream_;
  std::optional<StreamedFrame> frame_;
};

TEST_F(TurnedRing, RandomContentsNeverDeliverAFrameNorHang) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 2000; ++round) {
    ring_.published = random() % 3 == 0 ? random() : random() % 20;
    ring_.signal = static_cast<std::uint32_t>(random());
    segment_.put(0, ring_);
    for (std::uint64_t i = 0; i < 4; ++i) {
      slot_.lock = random() % 2 == 0 ? random() : 2 * (random() % 20);
      slot_.packet.sequence = random();
      slot_.packet.bytes = static_cast<std::uint32_t>(random());
      segment_.put(64 + i * 1344, slot_);
    }
    EXPECT_EQ(stream_->next(*frame_, 0ns), Arrival::timed_out);
  }
}

TEST_F(TurnedRing, AJumpOfItsCountIsNoOverrun) {
  segment_.put(offsetof(PillarfieldRing, published), std::uint64_t{1} << 63);
  EXPECT_EQ(stream_->next(*frame_, 0ns), Arrival::timed_out);
  EXPECT_LE(stream_->health().overrun, 1);
}

TEST_F(TurnedRing, MayShrinkAtAnyMoment) {
  for (const std::uint64_t bytes : {3000U, 1000U, 70U, 30U, 0U}) {
    ring_.published += 2;
    segment_.put(0, ring_);
    segment_.resize(bytes);
    EXPECT_EQ(stream_->next(*frame_, 120ms), Arrival::timed_out);
  }
}

TEST(HostileRing, CannotMisleadItsWriter) {
  const Name name;
  RingWriter writer(name.text(), kLayout, 4);
  Segment segment(name, 64 + 4 * 1344);
  std::mt19937_64 random(1);
  for (std::uint64_t round = 0; round < 200; ++round) {
    PillarfieldRing ring = {};
    ring.slots = static_cast<std::uint32_t>(random() % 3);
    ring.slot_bytes = ring.published = random();
    segment.put(0, ring);
    publish(writer, frame_packet(kShape, round));
  }
}

TEST(HostileRing, OfAnotherUserIsRefused) {
  if (geteuid() != 0) GTEST_SKIP() << "only root gives files away";
  const Name name;
  Segment segment(name, 64 + 4 * 1344);
  segment.put(0, ring_of_frames());
  ASSERT_EQ(chown(("/dev/shm/" + name.text()).c_str(), 65534, 65534), 0);
  EXPECT_NE(refusal_of(name.source()).find("another user"), std::string::npos);
}

TEST(HostileRing, APipeIsRefused) {
  const Name name;
  ASSERT_EQ(mkfifo(("/dev/shm/" + name.text()).c_str(), 0600), 0);
  EXPECT_NE(refusal_of(name.source()).find("no shared memory"), std::string::npos);
}

}  // namespace
}  // namespace pillarfield::streams_test
