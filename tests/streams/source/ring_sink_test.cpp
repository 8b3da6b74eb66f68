// The ring of results, as a control loop reads it.

#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "pillarfield/contact_columns.h"
#include "pillarfield/error.h"
#include "pillarfield/live.h"
#include "pillarfield/result_stream.h"
#include "streams/ring/ring_reader.h"
#include "streams/ring/ring_writer.h"
#include "tests/base/message.h"
#include "tests/streams/source/assembler_run.h"

namespace pillarfield::streams_test {
namespace {

std::string results_name() { return "pillarfield-results-" + std::to_string(getpid()); }

LiveSinkInfo info_of_skin(std::uint32_t rows, std::uint32_t cols) {
  LiveSinkInfo info;
  info.skin.rows = rows;
  info.skin.cols = cols;
  return info;
}

/// A solved frame of 3 x 5 pillars, and the planes that it refers to.
struct Solved {
  explicit Solved(std::uint64_t sequence) : field(3, 5) {
    const auto base = static_cast<float>(sequence);
    std::iota(field.shear_x.begin(), field.shear_x.end(), base);
    std::iota(field.shear_y.begin(), field.shear_y.end(), base + 100);
    std::iota(field.normal.begin(), field.normal.end(), base + 200);
    std::iota(field.status.begin(), field.status.end(), std::uint8_t{7});
    frame.forces = field.view();
    frame.sequence = sequence;
    frame.time_s = 0.25 * static_cast<double>(sequence);
    frame.arrived = std::chrono::steady_clock::now().time_since_epoch();
  }
  ForceField field;
  SolvedFrame frame;
};

PillarfieldResultSlot head_of(const std::byte* slot) {
  PillarfieldResultSlot head;
  std::memcpy(&head, slot, sizeof head);
  return head;
}

TEST(RingSink, KeepsTheStrongestContacts) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  FrameContacts contacts;
  for (std::uint64_t i = 0; i < 100; ++i) {
    TrackedContact contact;
    contact.track_id = i + 1;
    contact.quantities.normal_n = static_cast<double>(i * 37 % 100);
    contact.quantities.pillars = i;
    contact.quantities.centre_of_pressure = {static_cast<double>(i), -1};
    if (i % 2 == 0) contact.quantities.slip_margin = 0.5;
    contacts.contacts.push_back(contact);
  }
  contacts.total.normal_n = 77;
  Solved solved(1);
  solved.frame.contacts = &contacts;
  const SenselBlock missing = {0, 1, 0, 10};
  solved.frame.missing = {&missing, 1};
  sink->append(solved.frame);
  RingReader reader(results_name(), RingReader::Content::results);
  const PillarfieldResultSlot head = head_of(reader.read(300s));
  EXPECT_EQ(head.missing, 1);
  EXPECT_GE(head.published_ns, head.arrived_ns);
  const auto real = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(std::chrono::duration<double>(real).count(),
              1e-9 * static_cast<double>(head.arrived_unix_ns), 60);
  EXPECT_EQ(head.total.normal_n, 77);
  EXPECT_EQ(head.contacts_found, 100);
  ASSERT_EQ(head.contacts, PILLARFIELD_MAX_CONTACTS);
  for (std::uint32_t i = 0; i < head.contacts; ++i) {
    const PillarfieldContact& contact = head.contact[i];
    EXPECT_EQ(contact.normal_n, 99.0 - i);
    const TrackedContact& source = contacts.contacts[contact.track_id - 1];
    EXPECT_EQ(contact.normal_n, source.quantities.normal_n);
    EXPECT_EQ(contact.centre_x_mm, source.quantities.centre_of_pressure.x_mm);
    EXPECT_EQ(std::isnan(contact.slip_margin), !source.quantities.slip_margin);
  }
}

/// A contact whose every quantity differs.
TrackedContact told_contact() {
  TrackedContact contact;
  contact.track_id = 9;
  contact.label = 3;
  contact.first_time_s = 0.2;
  double value = 0;
  for (const QuantityColumn& column : quantity_columns()) {
    column.set(contact.quantities, column.kind == ColumnKind::word ? 3 : ++value);
  }
  contact.quantities.slip_forecast->high_s.reset();
  contact.quantities.mean_pressure_kpa =
      1000 * contact.quantities.normal_n / contact.quantities.area_mm2;
  return contact;
}

TEST(ResultStream, GivesWhatWasWritten) {
  LiveSinkInfo info = info_of_skin(6, 10);
  info.skin.sensel_pitch_mm = 0.7;
  const auto sink = create_live_sink("shm:" + results_name(), info);
  FrameContacts contacts;
  contacts.contacts = {told_contact(), {}};
  contacts.contacts[1].track_id = 4;
  contacts.total.area_mm2 = 20;
  contacts.total.normal_n = 30;
  Solved solved(8);
  solved.frame.contacts = &contacts;
  sink->append(solved.frame);
  const auto stream = open_result_stream("shm:" + results_name(), {});
  ASSERT_NE(stream, nullptr);
  EXPECT_EQ(stream->skin().element_rows(), 3);
  EXPECT_EQ(stream->skin().element_cols(), 5);
  EXPECT_EQ(stream->skin().element_pitch_mm(), Pitch(1.4));
  StreamedResult result;
  ASSERT_TRUE(stream->next(result, 300s));
  EXPECT_EQ(result.sequence, 8);
  EXPECT_EQ(result.time_s, 2);
  EXPECT_EQ(result.arrived, solved.frame.arrived);
  EXPECT_EQ(result.forces.shear_x, solved.field.shear_x);
  EXPECT_EQ(result.forces.shear_y, solved.field.shear_y);
  EXPECT_EQ(result.forces.normal, solved.field.normal);
  EXPECT_EQ(result.forces.status, solved.field.status);
  ASSERT_TRUE(result.contacts);
  EXPECT_EQ(result.contacts->total.normal_n, 30);
  ASSERT_EQ(result.contacts->contacts.size(), 2);
  EXPECT_EQ(result.contacts->contacts[0].track_id, 4);
  EXPECT_FALSE(result.contacts->contacts[0].quantities.slip_forecast);
  const TrackedContact& told = result.contacts->contacts[1];
  const TrackedContact expected = told_contact();
  EXPECT_EQ(told.track_id, expected.track_id);
  EXPECT_EQ(told.label, expected.label);
  EXPECT_EQ(told.age_s, 1.8);
  for (const QuantityColumn& column : quantity_columns()) {
    const double value = column.get(told.quantities);
    const double written = column.get(expected.quantities);
    EXPECT_TRUE(value == written || (std::isnan(value) && std::isnan(written))) << column.name;
  }
  EXPECT_FALSE(stream->next(result, 0s));

  // Without contacts there are none, rather than an empty list; a gap is counted.
  sink->append(Solved(11).frame);
  ASSERT_TRUE(stream->next(result, 300s));
  EXPECT_FALSE(result.contacts);
  EXPECT_EQ(stream->health().frames, 2);
  EXPECT_EQ(stream->health().lost, 2);
}

TEST(ResultStream, WithoutPillarsHasNoShear) {
  LiveSinkInfo info = info_of_skin(3, 5);
  info.skin.layout = SkinLayout::sensels;
  info.skin.sensel_pitch_mm = {7.625, 5.08};
  const auto sink = create_live_sink("shm:" + results_name(), info);
  Solved solved(1);
  solved.frame.forces.shear_x = solved.frame.forces.shear_y = {};
  FrameContacts contacts;
  contacts.total.has_shear = false;
  solved.frame.contacts = &contacts;
  sink->append(solved.frame);
  RingReader reader(results_name(), RingReader::Content::results);
  EXPECT_TRUE(std::isnan(head_of(reader.read(300s)).total.shear_x_n));
  const auto stream = open_result_stream("shm:" + results_name(), {});
  StreamedResult result;
  ASSERT_TRUE(stream->next(result, 300s));
  EXPECT_FALSE(stream->skin().has_pillars());
  EXPECT_EQ(stream->skin().sensel_pitch_mm, Pitch(7.625, 5.08));
  EXPECT_TRUE(result.forces.shear_x.empty());
  EXPECT_EQ(result.forces.normal, solved.field.normal);
  EXPECT_FALSE(result.contacts->total.has_shear);
  EXPECT_EQ(result.contacts->total.shear_x_n, 0);
}

TEST(ResultStream, FollowsANewRingOfTheSameLayoutAlone) {
  auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  sink->append(Solved(1).frame);
  const auto stream = open_result_stream("shm:" + results_name(), {});
  StreamedResult result;
  ASSERT_TRUE(stream->next(result, 300s));
  sink.reset();
  LiveSinkInfo info = info_of_skin(6, 10);
  info.skin.sensel_pitch_mm = 2;
  sink = create_live_sink("shm:" + results_name(), info);
  sink->append(Solved(2).frame);
  for (int i = 0; i < 3000 && stream->health().mismatch.empty(); ++i) {
    EXPECT_FALSE(stream->next(result, 100ms));
  }
  EXPECT_EQ(stream->health().mismatch, "results are 3 x 5 of 4 mm, 3 x 5 of 1.26491 mm expected");
  sink.reset();
  sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  sink->append(Solved(0).frame);
  ASSERT_TRUE(stream->next(result, 300s));
  EXPECT_EQ(result.sequence, 0);
  EXPECT_EQ(stream->health().restarts, 1);
}

TEST(ResultStream, RefusesRingsOfOtherKindsAndVersions) {
  const std::string source = "shm:" + results_name();
  const auto message = [&] {
    return core_test::message_of([&] { (void)open_result_stream(source, {}); });
  };
  {
    const RingWriter frames(results_name(), {PILLARFIELD_RING_FRAMES, 6, 10, PILLARFIELD_U8}, 4);
    EXPECT_EQ(open_result_stream(source, {}), nullptr);
  }
  int asked = 0;
  EXPECT_EQ(open_result_stream(source, [&] { return ++asked == 2; }), nullptr);
  const auto sink = create_live_sink(source, info_of_skin(6, 10));
  std::fstream segment("/dev/shm/" + results_name(), std::ios::in | std::ios::out);
  for (const char kind : {'\2', '\3', '\4', '\5'}) {
    segment.seekp(offsetof(PillarfieldRing, kind)).put(kind).flush();
    EXPECT_NE(message().find("results in the layout of an earlier version"), std::string::npos);
  }
  segment.seekp(offsetof(PillarfieldRing, kind)).put('\x8').flush();
  EXPECT_NE(message().find("is not a ring of frames or results"), std::string::npos);
  EXPECT_NE(core_test::message_of([] { (void)open_result_stream("udp:1", {}); }).find("shm:NAME"),
            std::string::npos);
}

TEST(RingSink, StopsAtAFrameOfAnotherSize) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 12));
  sink->append(Solved(1).frame);
  EXPECT_EQ(sink->statistics().frames, 0);
  EXPECT_NE(sink->statistics().failure, "");
  EXPECT_FALSE(std::filesystem::exists("/dev/shm/" + results_name()));
}

TEST(RingSink, StopsWhenAnotherProgramShortensItsRing) {
  for (const off_t bytes : {0, 100, 4096}) {
    const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
    ASSERT_EQ(truncate(("/dev/shm/" + results_name()).c_str(), bytes), 0);
    for (std::uint64_t i = 0; i < 5; ++i) sink->append(Solved(i).frame);
    EXPECT_EQ(sink->statistics().failure, "another program shortened the shared memory") << bytes;
  }
}

TEST(LiveSink, RefusesWhatIsNoTarget) {
  for (const char* target :
       {"", "shm", "udp", "shm:", "udp:", "foo:bar", "a.txt", "a.mcap/", "/nowhere/at/all.mcap",
        "udp:127.0.0.1", "udp:127.0.0.1:0", "udp:127.0.0.1:65536", "udp:127.0.0.1:9x",
        "udp::", "foxglove:127.0.0.1", "foxglove:x:1", "foxglove:99999", "foxglove:1.2.3:5",
        "foxglove:-1"}) {
    EXPECT_THROW((void)create_live_sink(target, info_of_skin(6, 10)), Error) << target;
  }
}

TEST(RingSink, RefusesANameInUse) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  const std::string message = core_test::message_of(
      [] { (void)create_live_sink("shm:" + results_name(), info_of_skin(6, 10)); });
  EXPECT_NE(message.find("another program writes this ring"), std::string::npos) << message;
}

TEST(RingSink, NeverRemovesMemoryThatIsNotARing) {
  const auto place = std::filesystem::path("/dev/shm") / results_name();
  const auto open = [] { (void)create_live_sink("shm:" + results_name(), info_of_skin(6, 10)); };
  for (const std::string& foreign :
       {std::string(7000, 'x'), std::string("x"), std::string(7000, '\0'), std::string("PRG2")}) {
    std::ofstream(place) << foreign;
    const std::string message = core_test::message_of(open);
    EXPECT_NE(message.find("is not a ring of Pillarfield"), std::string::npos) << message;
    EXPECT_EQ(std::filesystem::file_size(place), foreign.size());
  }
  // Left by a writer that was killed before it finished its ring.
  PillarfieldRing unfinished = {};
  unfinished.kind = PILLARFIELD_RING_FRAMES;
  unfinished.rows = unfinished.cols = 8;
  unfinished.type = PILLARFIELD_U8;
  unfinished.slots = 4;
  unfinished.slot_bytes = 1344;
  std::ofstream(place).write(reinterpret_cast<const char*>(&unfinished), sizeof unfinished);
  open();
  EXPECT_FALSE(std::filesystem::exists(place));
}

}  // namespace
}  // namespace pillarfield::streams_test
