// Live sources as a program opens them: standard input, UDP, serial lines.

#include <arpa/inet.h>
#include <fcntl.h>

#include <array>
#include <bit>
#include <cstdlib>
#include <filesystem>

#include "pillarfield/error.h"
#include "tests/base/message.h"
#include "tests/streams/source/source_run.h"

namespace pillarfield::streams_test {
namespace {

/// `action` must throw an Error that says `text`.
template <class Action>
void expect_failure(Action action, const std::string& text) {
  const std::string message = core_test::message_of(action);
  EXPECT_NE(message.find(text), std::string::npos) << message;
}

constexpr FrameShape kShape = {SenselType::u8, 16, 24};

/// A pipe as standard input while it lives.
class Stdin {
 public:
  Stdin() : saved_(dup(STDIN_FILENO)) {
    std::array<int, 2> ends = {};
    EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    dup2(ends[0], STDIN_FILENO);
    close(ends[0]);
    input_ = ends[1];
  }
  ~Stdin() {
    end();
    dup2(saved_, STDIN_FILENO);
    close(saved_);
  }
  void send(const std::string& bytes) const { write_all(input_, bytes); }
  void end() {
    if (input_ >= 0) close(input_);
    input_ = -1;
  }

 private:
  int saved_;
  int input_ = -1;
};

TEST(StdinSource, DeliversFramesAndEnds) {
  Stdin input;
  input.send("rubbish" + frame_packet(kShape, 5).bytes() + frame_packet(kShape, 6).bytes());
  const auto stream = open_live_source("-", {});
  EXPECT_EQ(stream->skin().rows, kShape.rows);
  EXPECT_EQ(stream->skin().cols, kShape.cols);
  EXPECT_EQ(stream->sensel_type(), SenselType::u8);
  std::vector<std::string> received;
  EXPECT_FALSE(
      take_frames(*stream, 10ms, [&](auto& frame) { received.push_back(bytes_of(frame)); }));
  input.send(frame_packet(kShape, 8).bytes() + row_packets(kShape, 9, 2)[1].bytes());
  input.end();
  EXPECT_TRUE(
      take_frames(*stream, 300s, [&](auto& frame) { received.push_back(bytes_of(frame)); }));
  ASSERT_EQ(received.size(), 4);
  EXPECT_EQ(received[0], readings_of(kShape, 5));
  EXPECT_EQ(received[2], readings_of(kShape, 8));
  const std::size_t half = kShape.bytes() / 2;
  EXPECT_EQ(received[3],
            readings_of(kShape, 8).substr(0, half) + readings_of(kShape, 9).substr(half));
  expect_counts(stream->health(), {.frames = 4, .lost = 1, .incomplete = 1});
}

TEST(StdinSource, GivesUpOnRubbishWithoutEnd) {
  const int zeros = open("/dev/zero", O_RDONLY | O_CLOEXEC);
  const int saved = dup(STDIN_FILENO);
  dup2(zeros, STDIN_FILENO);
  int asked = 0;
  EXPECT_EQ(open_live_source("-", {.stop = [&] { return ++asked == 2; }}), nullptr);
  dup2(saved, STDIN_FILENO);
  close(saved);
  close(zeros);
}

TEST(StdinSource, RefusesAnEndWithoutAFrame) {
  Stdin input;
  input.send("no packet at all");
  input.end();
  expect_failure([] { (void)open_live_source("-", {}); }, "ended before its first frame");
}

TEST(StdinSource, NamesFramesOfAnotherSize) {
  Stdin input;
  input.send(frame_packet(kShape, 0).bytes());
  expect_failure(
      [] {
        (void)open_live_source("-", {.size = FrameSize{8, 8}});
      },
      "frames are 16 x 24, 8 x 8 expected");
  input.send(frame_packet(kShape, 1).bytes());
  const auto stream = open_live_source("-", {.size = FrameSize{16, 24}});
  EXPECT_EQ(stream->health().mismatch, "");
  input.send(frame_packet({SenselType::u16, 16, 24}, 2).bytes());
  input.end();
  EXPECT_TRUE(take_frames(*stream, 1s, [](auto&) {}));
  EXPECT_EQ(stream->health().mismatch, "frames are uint16, uint8 expected");
}

TEST(StdinSource, RefusesACalibrationOfAnotherSize) {
  Stdin input;
  input.send(frame_packet(kShape, 0).bytes());
  LiveSourceOptions options;
  options.calibration.tare.assign(3, 0);
  expect_failure([&] { (void)open_live_source("-", options); }, "standard input");
}

/// A socket that sends to a port of this computer that was free.
class Sender {
 public:
  explicit Sender(int family) {
    const int probe = socket(family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    socklen_t size = sizeof address_;
    address_.ss_family = static_cast<sa_family_t>(family);
    if (family == AF_INET) {
      reinterpret_cast<sockaddr_in*>(&address_)->sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    } else {
      reinterpret_cast<sockaddr_in6*>(&address_)->sin6_addr = in6addr_loopback;
    }
    bound_ = bind(probe, reinterpret_cast<sockaddr*>(&address_), size) == 0;
    getsockname(probe, reinterpret_cast<sockaddr*>(&address_), &size);
    close(probe);
    socket_ = socket(family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  }
  ~Sender() { close(socket_); }
  [[nodiscard]] bool has_port() const { return bound_; }
  [[nodiscard]] std::string source() const {
    // The port has the same place in both kinds of address.
    const int port = ntohs(reinterpret_cast<const sockaddr_in*>(&address_)->sin_port);
    const char* const host = address_.ss_family == AF_INET ? "127.0.0.1" : "[::1]";
    return std::string("udp:") + host + ":" + std::to_string(port);
  }
  void send(const std::string& bytes) const {
    sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address_),
           sizeof address_);
  }
  /// Opens the source; a packet is sent until it has arrived.
  [[nodiscard]] std::unique_ptr<FrameStream> open(const SentPacket& first) const {
    return open_live_source(source(), {.stop = [this, first] {
                              send(first.bytes());
                              return false;
                            }});
  }

 private:
  sockaddr_storage address_ = {};
  int socket_ = -1;
  bool bound_ = false;
};

TEST(UdpSource, DeliversAndCountsByBothFamilies) {
  for (const int family : {AF_INET, AF_INET6}) {
    const Sender sender(family);
    if (!sender.has_port()) continue;  // no loopback of this family
    const auto stream = sender.open(frame_packet(kShape, 0));
    ASSERT_NE(stream, nullptr);
    take_frames(*stream, 30ms, [](auto&) {});
    const StreamHealth before = stream->health();
    const std::vector<SentPacket> parts = row_packets(kShape, 3, 2);
    for (const SentPacket& packet :
         {frame_packet(kShape, 1), parts[1], parts[0], parts[0], frame_packet(kShape, 4)}) {
      sender.send(packet.bytes());
    }
    sender.send("too short");
    std::vector<std::string> received;
    take_frames(*stream, 40ms, [&](auto& frame) { received.push_back(bytes_of(frame)); });
    EXPECT_EQ(received, (std::vector{readings_of(kShape, 1), readings_of(kShape, 3),
                                     readings_of(kShape, 4)}));
    expect_counts(stream->health(), {.frames = before.frames + 3,
                                     .lost = 1,
                                     .duplicates = before.duplicates + 1,
                                     .invalid = 1});
    EXPECT_EQ(stream->health().overrun, 0);
  }
}

TEST(UdpSource, CountsWhatTheKernelDropped) {
  const Sender sender(AF_INET);
  const auto stream = sender.open(frame_packet(kShape, 0));
  std::uint64_t sequence = 0;
  const auto send = [&](int frames) {
    SentPacket packet = frame_packet(kShape, 0);
    for (int i = 0; i < frames; ++i) {
      packet.header.sequence = ++sequence;
      sender.send(packet.bytes());
    }
  };
  const auto count = [](auto&) {};
  send(60'000);  // more than any buffer holds
  take_frames(*stream, 30ms, count);
  send(2);  // bring the number of drops
  take_frames(*stream, 30ms, count);
  const StreamHealth health = stream->health();
  EXPECT_GT(health.lost, 0);
  EXPECT_EQ(health.lost, health.overrun);
  EXPECT_EQ(health.frames + health.lost, sequence + 1);
}

TEST(UdpSource, AClaimFixesNoSize) {
  constexpr FrameShape kClaimed = {SenselType::f32, 65534, 256};
  SentPacket claim = {header_of(kClaimed, 0), std::string(kClaimed.row_bytes(), '\0')};
  claim.header.content = PILLARFIELD_ROWS;
  claim.header.parts = 65534;
  claim.header.count = 1;
  claim.header.bytes = static_cast<std::uint32_t>(claim.readings.size());
  const Sender sender(AF_INET);
  const auto stream = open_live_source(sender.source(), {.stop = [&] {
                                         sender.send(claim.bytes());
                                         sender.send(frame_packet(kShape, 1).bytes());
                                         return false;
                                       }});
  EXPECT_EQ(stream->skin().rows, kShape.rows);
  EXPECT_GE(stream->health().invalid, 1);
}

/// The skin of a source whose packets are these.
Skin skin_from(const std::vector<SentPacket>& packets, const LiveSourceOptions& options = {}) {
  Stdin input;
  for (const SentPacket& packet : packets) input.send(packet.bytes());
  return open_live_source("-", options)->skin();
}

SentPacket stating(SentPacket packet, std::uint32_t first, float counts_per_newton) {
  packet.header.first = first;
  packet.header.count = std::bit_cast<std::uint32_t>(counts_per_newton);
  return packet;
}

TEST(StdinSource, TakesTheConstantsThatPacketsState) {
  const SentPacket silent = frame_packet(kShape, 1);
  const Skin assumed = skin_from({silent});
  EXPECT_EQ(assumed.layout, SkinLayout::sensels);
  EXPECT_FALSE(assumed.stated.layout || assumed.states_pitch() ||
               assumed.states_counts_per_newton());

  // NOLINTNEXTLINE(bugprone-incorrect-roundings): a macro of C for positive numbers
  const SentPacket frame = stating(silent, PILLARFIELD_STATED(PILLARFIELD_PILLARS, 5), 47);
  SentPacket constants = {frame.header, ""};
  constants.header.content = PILLARFIELD_CONSTANTS;
  constants.header.bytes = 0;
  std::vector<SentPacket> rows = row_packets(kShape, 1, 4);
  rows.insert(rows.begin() + 3, constants);
  for (const auto& packets : {std::vector{frame}, rows}) {
    const Skin skin = skin_from(packets);
    EXPECT_EQ(skin.layout, SkinLayout::pillars);
    EXPECT_DOUBLE_EQ(skin.sensel_pitch_mm.col_mm, 5);
    EXPECT_EQ(skin.counts_per_newton, 47);
    EXPECT_TRUE(skin.stated.layout && skin.states_pitch() && skin.states_counts_per_newton());
  }
  // Members that earlier drivers left as they were.
  const Skin odd = skin_from({stating(silent, 16, 1e-40F)});
  EXPECT_FALSE(odd.stated.layout || odd.stated.sensel_pitch || odd.stated.counts_per_newton);

  const Skin given =
      skin_from({frame}, {.read = {.sensel_pitch_mm = 2, .layout = SkinLayout::sensels}});
  EXPECT_EQ(given.layout, SkinLayout::sensels);
  EXPECT_EQ(given.sensel_pitch_mm, 2);
  EXPECT_EQ(given.counts_per_newton, 47);

  std::vector<std::string> said;
  const auto say = [&](const std::string& words) { said.push_back(words); };
  EXPECT_TRUE(skin_from({silent}, {.skin = Skin{}, .say = say}).has_pillars());
  EXPECT_EQ(said.size(), 1);
  EXPECT_TRUE(skin_from({frame}, {.skin = Skin{}, .say = say}).has_pillars());
  EXPECT_EQ(said.size(), 1);
}

TEST(UdpSource, WaitsForFramesOfTheStatedSize) {
  constexpr FrameShape kOther = {SenselType::u8, 8, 8};
  const Sender sender(AF_INET);
  std::vector<std::string> said;
  int asked = 0;
  const auto stream = open_live_source(
      sender.source(), {.size = FrameSize{kShape.rows, kShape.cols},
                        .say = [&](const std::string& words) { said.push_back(words); },
                        .stop =
                            [&] {
                              sender.send(frame_packet(++asked < 3 ? kOther : kShape, 1).bytes());
                              return false;
                            }});
  EXPECT_EQ(stream->skin().rows, kShape.rows);
  EXPECT_EQ(said, std::vector<std::string>{"frames are 8 x 8, 16 x 24 expected"});
  EXPECT_EQ(stream->health().mismatch, "");
  sender.send(frame_packet(kOther, 2).bytes());
  take_frames(*stream, 30ms, [](auto&) {});
  EXPECT_EQ(stream->health().mismatch, "frames are 8 x 8, 16 x 24 expected");
}

TEST(UdpSource, ReturnsBetweenShortDatagrams) {
  const Sender sender(AF_INET);
  const auto stream = sender.open(frame_packet(kShape, 0));
  take_frames(*stream, 30ms, [](auto&) {});
  for (int i = 0; i < 1000; ++i) sender.send("");  // the smallest buffer holds over 200
  StreamedFrame frame(stream->sensel_type(), stream->skin());
  (void)stream->next(frame, 0ns);
  EXPECT_GT(stream->health().invalid, 0);
  EXPECT_LE(stream->health().invalid, 128);
}

/// A pseudo-terminal, whose other end has a name that the test chooses.
class Terminal {
 public:
  explicit Terminal(const std::filesystem::path& link)
      : controller_(posix_openpt(O_RDWR | O_NOCTTY)) {
    grantpt(controller_);
    unlockpt(controller_);
    std::filesystem::remove(link);
    std::filesystem::create_symlink(ptsname(controller_), link);
  }
  ~Terminal() { close(controller_); }
  void send(const std::string& bytes) const { write_all(controller_, bytes); }

 private:
  int controller_;
};

/// A folder that is removed at the end.
struct Folder {
  Folder() {
    std::string name = std::filesystem::temp_directory_path() / "serial-XXXXXX";
    path = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path); }
  std::filesystem::path path;
};

constexpr FrameShape kSmall = {SenselType::u8, 8, 8};

TEST(SerialSource, FindsPacketsBetweenRubbishAndReopensTheDevice) {
  const Folder folder;
  const std::filesystem::path device = folder.path / "tty";
  std::vector<std::string> received;
  const auto take = [&](const StreamedFrame& frame) { received.push_back(bytes_of(frame)); };
  auto terminal = std::make_unique<Terminal>(device);
  const auto stream = open_live_source("serial:" + device.string(), {.stop = [&] {
                                         terminal->send(checked(frame_packet(kSmall, 0)).bytes());
                                         return false;
                                       }});
  std::mt19937 random(1);
  for (std::uint64_t i = 1; i < 30; ++i) {
    SentPacket packet = checked(frame_packet(kSmall, i));
    if (i % 3 == 0) terminal->send("\x03\x04\x11\x13\r\n\xff noise");
    if (i % 7 == 0) packet.readings[random() % 64] ^= 8;
    terminal->send(packet.bytes());
    take_frames(*stream, 5ms, take);
  }
  take_frames(*stream, 300ms, take);
  // The noise after packet 14 belongs to the same run of rubbish.
  expect_counts(stream->health(), {.frames = 26, .lost = 4, .invalid = 9 + 4 - 1});
  terminal.reset();
  take_frames(*stream, 20ms, take);
  terminal = std::make_unique<Terminal>(device);
  take_frames(*stream, 300ms, take);
  terminal->send(checked(frame_packet(kSmall, 40)).bytes());
  terminal->send(checked(frame_packet(kSmall, 41)).bytes());
  take_frames(*stream, 300ms, take);
  ASSERT_EQ(received.size(), 28);
  EXPECT_EQ(received.front(), readings_of(kSmall, 0));
  EXPECT_EQ(received.back(), readings_of(kSmall, 41));
}

TEST(LiveSource, KnowsItsKinds) {
  for (const char* const source : {"-", "shm:skin", "udp:127.0.0.1:9", "serial:/dev/ttyACM0"}) {
    EXPECT_TRUE(is_live_source(source)) << source;
  }
  for (const char* const source : {"", "-x", "skin.h5", "udp", "./shm:x"}) {
    EXPECT_FALSE(is_live_source(source)) << source;
  }
}

/// Names that are none, and words of the error.
constexpr const char* kWrongSources[][2] = {
    {"skin.h5", "give one of -, shm:NAME, udp:ADDRESS:PORT, serial:DEVICE"},
    {"udp:", "udp:"},
    {"udp:127.0.0.1:", "udp:"},
    {"udp:127.0.0.1:0", "udp:"},
    {"udp:127.0.0.1:65536", "udp:"},
    {"udp:nowhere:99", "udp:"},
    {"shm:", "is not the name of a ring"},
    {"shm:a/b", "is not the name of a ring"},
    {"shm:..", "is not the name of a ring"},
    {"shm:a b", "is not the name of a ring"},
    {"serial:", "serial:"},
    {"serial:/nowhere", "serial:/nowhere"},
    {"serial:/dev/null", "serial:/dev/null"},
    {"serial:x?protocol=flexi",
     "protocol 'flexi' is unknown; did you mean 'flexitac'?; give one of packets, flexitac"},
    // As a shell passes it that took '&' for its own.
    {"serial:x?protocol=flexitac",
     "needs rows and cols; rows is missing; give, in quotes, 'serial:"},
    {"serial:x?protocol=flexitac&rows=16", "cols is missing"},
    {"serial:x?protocol=flexitac&cols=32&rows=0", "rows is '0', not a number from 1 to 65534"},
    {"serial:x?protocol=flexitac&cols=32&rows=65535", "rows is '65535', not a number"},
    {"serial:x?protocol=flexitac&cols=32&rows=16x", "rows is '16x', not a number"},
    {"serial:x?protocol=flexitac&rows=65534&cols=65534", "65534 x 65534 sensels are too many"},
    {"serial:x?protocol=flexitac&rows=16&col=32", "option 'col' is unknown; did you mean 'cols'?"},
    {"serial:x?protocol=flexitac&rows=16&rows=16", "option 'rows' has two values"},
    {"serial:x?rows", "option 'rows' has no value"},
    {"serial:x?rows=16&cols=32", "packets bring rows and columns"},
    {"serial:x?\x1b=1", "option '\\u001b' is unknown"},
};

TEST(LiveSource, RefusesWrongNamesInOneLine) {
  for (const auto& [source, words] : kWrongSources) {
    const std::string message = core_test::message_of(
        [name = source] { (void)open_live_source(name, {.stop = [] { return true; }}); });
    EXPECT_NE(message.find(words), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace pillarfield::streams_test
