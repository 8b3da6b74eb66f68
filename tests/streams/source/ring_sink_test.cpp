// The ring of results, as a control loop reads it.

#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <numeric>

#include "pillarfield/error.h"
#include "pillarfield/live.h"
#include "streams/ring/ring_reader.h"
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

template <class T>
std::vector<T> values_at(const std::byte* place, std::size_t count) {
  std::vector<T> values(count);
  std::memcpy(values.data(), place, count * sizeof(T));
  return values;
}

PillarfieldResultSlot head_of(const std::byte* slot) {
  PillarfieldResultSlot head;
  std::memcpy(&head, slot, sizeof head);
  return head;
}

TEST(RingSink, PublishesPlanesTimesAndTotal) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  EXPECT_EQ(sink->name(), "shm:" + results_name());
  RingReader reader(results_name(), PILLARFIELD_RING_RESULTS);
  for (std::uint64_t sequence = 40; sequence < 60; ++sequence) {
    Solved solved(sequence);
    const SenselBlock missing = {0, 1, 0, 10};
    if (sequence % 2 == 1) solved.frame.missing = {&missing, 1};
    sink->append(solved.frame);
    const std::byte* const slot = reader.read(300s);
    ASSERT_NE(slot, nullptr);
    const PillarfieldResultSlot head = head_of(slot);
    EXPECT_EQ(head.sequence, sequence);
    EXPECT_EQ(head.time_s, solved.frame.time_s);
    EXPECT_EQ(head.arrived_ns, static_cast<std::uint64_t>(solved.frame.arrived.count()));
    EXPECT_GE(head.published_ns, head.arrived_ns);
    const auto real = std::chrono::system_clock::now().time_since_epoch();
    EXPECT_NEAR(std::chrono::duration<double>(real).count(),
                1e-9 * static_cast<double>(head.arrived_unix_ns), 1);
    EXPECT_EQ(head.missing, sequence % 2);
    EXPECT_EQ(head.contacts, 0);
    EXPECT_EQ(head.total.normal_n,
              std::accumulate(solved.field.normal.begin(), solved.field.normal.end(), 0.0));
    EXPECT_TRUE(std::isnan(head.total.friction));
    const std::byte* const planes = slot + sizeof head;
    EXPECT_EQ(values_at<float>(planes, 15), solved.field.shear_x);
    EXPECT_EQ(values_at<float>(planes + 60, 15), solved.field.shear_y);
    EXPECT_EQ(values_at<float>(planes + 120, 15), solved.field.normal);
    EXPECT_EQ(values_at<std::uint8_t>(planes + 180, 15), solved.field.status);
  }
  EXPECT_EQ(sink->statistics().frames, 20);
  sink->finish();
  EXPECT_FALSE(std::filesystem::exists("/dev/shm/" + results_name()));
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
  sink->append(solved.frame);
  RingReader reader(results_name(), PILLARFIELD_RING_RESULTS);
  const PillarfieldResultSlot head = head_of(reader.read(300s));
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

TEST(RingSink, StopsAtAFrameOfAnotherSize) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 12));
  sink->append(Solved(1).frame);
  EXPECT_EQ(sink->statistics().frames, 0);
  EXPECT_NE(sink->statistics().failure, "");
  EXPECT_FALSE(std::filesystem::exists("/dev/shm/" + results_name()));
}

TEST(RingSink, StopsWhenAnotherProgramShortensItsRing) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  ASSERT_EQ(truncate(("/dev/shm/" + results_name()).c_str(), 0), 0);
  for (std::uint64_t i = 0; i < 3; ++i) sink->append(Solved(i).frame);
  EXPECT_EQ(sink->statistics().failure, "another program shortened the shared memory");
}

TEST(LiveSink, AKindWithoutItsTargetIsNone) {
  for (const char* target : {"shm", "udp", "shm:", "udp:"}) {
    EXPECT_THROW((void)create_live_sink(target, info_of_skin(6, 10)), Error) << target;
  }
}

TEST(RingSink, RefusesANameInUse) {
  const auto sink = create_live_sink("shm:" + results_name(), info_of_skin(6, 10));
  const std::string message = core_test::message_of(
      [] { (void)create_live_sink("shm:" + results_name(), info_of_skin(6, 10)); });
  EXPECT_NE(message.find("another program writes this ring"), std::string::npos) << message;
}

}  // namespace
}  // namespace pillarfield::streams_test
