// Results of another program on display, read from its ring.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "pillarfield/error.h"
#include "pillarfield/live.h"
#include "tests/viewer/source/touched_field.h"
#include "viewer/source/live_player.h"
#include "viewer/source/shown_contacts.h"

namespace pillarfield::viewer {
namespace {

constexpr std::uint32_t kRows = 8;
constexpr std::uint32_t kCols = 12;

std::string ring_name() { return "shm:pillarfield-viewer-" + std::to_string(getpid()); }

template <class Condition>
void wait_till(Condition condition) {
  bool holds = condition();
  for (int i = 0; i < 300'000 && !holds; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    holds = condition();
  }
  ASSERT_TRUE(holds);
}

/// A program that publishes results.
class Program {
 public:
  Program() {
    LiveSinkInfo info;
    info.skin.rows = 2 * kRows;
    info.skin.cols = 2 * kCols;
    info.skin.sensel_pitch_mm = 0.75;
    sink_ = create_live_sink(ring_name(), info);
  }

  /// Two touches, of which the heavier one slips soon.
  void send(float normal, std::uint32_t label = 1) {
    const ShownField field =
        touched_field(sent_, kRows, kCols, {{{0, 2, 1, 3}, 1}, {{4, 7, 5, 9}, normal, 0.5F}});
    FrameContacts contacts;
    contacts.contacts.resize(2);
    contacts.contacts[0].track_id = 3;
    contacts.contacts[0].quantities.pillars = 4;
    contacts.contacts[0].quantities.normal_n = 4;
    contacts.contacts[1].track_id = 7;
    contacts.contacts[1].label = label;
    contacts.contacts[1].quantities.pillars = 12;
    contacts.contacts[1].quantities.normal_n = static_cast<double>(12 * normal);
    contacts.contacts[1].quantities.slip_forecast = {0.4, 0.2, 0.9, {0, 0.1, 0.99}};
    contacts.total.normal_n = 42;
    append(field, &contacts);
  }
  void send_without_contacts() {
    append(touched_field(sent_, kRows, kCols, {{{1, 3, 1, 3}, 2}}), nullptr);
  }

 private:
  void append(const ShownField& field, const FrameContacts* contacts) {
    sink_->append({.forces = field.forces,
                   .contacts = contacts,
                   .time_s = 0.01 * static_cast<double>(sent_),
                   .sequence = sent_,
                   .arrived = std::chrono::steady_clock::now().time_since_epoch()});
    ++sent_;
  }

  std::unique_ptr<LiveSink> sink_;
  std::uint64_t sent_ = 0;
};

struct ShownResults {
  OpenedSensor opened = open_sensor(ring_name(), {});
  Player& player = *opened.player;

  [[nodiscard]] LiveStatus status() const { return player.live()->status(); }
  void wait_for_results(std::uint64_t count) const {
    wait_till([&] { return status().health.solved == count; });
  }
  [[nodiscard]] ShownField newest() const {
    std::optional<ShownField> newest;
    wait_till([&] { return (newest = player.take()).has_value(); });
    return newest.value();
  }
};

TEST(ResultPlayer, ShowsForcesAndContactsOfTheOtherProgram) {
  Program program;
  const ShownResults shown;
  shown.player.set_contacts(true);
  program.send(5);
  const SourceInfo& info = shown.player.info();
  EXPECT_EQ(info.kind, "results");
  EXPECT_EQ(info.skin.element_rows(), kRows);
  EXPECT_EQ(info.skin.element_pitch_mm(), 1.5);
  EXPECT_FALSE(info.has_readings);
  EXPECT_TRUE(info.has_angles);
  const ShownField field = shown.newest();
  const std::size_t heavy = std::size_t{5} * kCols + 6;
  EXPECT_EQ(field.forces.normal[heavy], 5);
  EXPECT_EQ(field.forces.shear_x[heavy], 0.5F);
  EXPECT_FLOAT_EQ(field.forces.magnitude[heavy], std::hypot(5.0F, 0.5F));
  EXPECT_FALSE(field.pages.empty());
  EXPECT_TRUE(field.arrived);
  ASSERT_NE(field.contacts, nullptr);
  const ShownContacts& contacts = *field.contacts;
  EXPECT_EQ(contacts.found.total.normal_n, 42);
  ASSERT_EQ(contacts.found.contacts.size(), 2U);
  const std::size_t first = contacts.heaviest.front();
  EXPECT_EQ(contacts.found.contacts[first].track_id, 7U);
  EXPECT_EQ(contacts.extents[first].row_begin, 4U);
  EXPECT_EQ(contacts.extents[first].col_end, 9U);
  EXPECT_EQ(contacts.found.contacts[first].quantities.slip_forecast->time_s, 0.4);
  program.send(2);
  const ShownField next = shown.newest();
  EXPECT_EQ(next.forces.normal[heavy], 2);
  EXPECT_GT(next.time_s, field.time_s);
  EXPECT_EQ(next.index, 1U);
  const auto points = shown.opened.curves->between(-1, 1e9, 10);
  ASSERT_EQ(points.size(), 2U);
  EXPECT_FLOAT_EQ(points.back().normal, 12 * 2 + 4);
}

TEST(ResultPlayer, ContactsComeAndGoWhileNoResultDoes) {
  Program program;
  program.send(5);
  const ShownResults shown;
  EXPECT_EQ(shown.newest().contacts, nullptr);
  shown.player.set_contacts(true);
  EXPECT_NE(shown.newest().contacts, nullptr);
  shown.player.set_contacts(false);
  EXPECT_EQ(shown.newest().contacts, nullptr);
}

TEST(ResultPlayer, FindsContactsThatTheRingLacksAndTrustsNone) {
  Program program;
  const ShownResults shown;
  shown.player.set_contacts(true);
  program.send(5, 99);  // No contact has this label.
  const auto lying = shown.newest().contacts;
  ASSERT_EQ(lying->found.contacts.size(), 1U);
  EXPECT_EQ(lying->found.contacts[0].track_id, 3U);
  program.send_without_contacts();
  const auto found = shown.newest().contacts;
  ASSERT_EQ(found->found.contacts.size(), 1U);
  EXPECT_EQ(found->found.contacts[0].quantities.normal_n, 8);
}

TEST(ResultPlayer, HasNoReadingsToRecord) {
  const Program program;
  const ShownResults shown;
  EXPECT_THROW(shown.player.live()->record("recording.h5"), Error);
  EXPECT_THROW(
      (void)open_sensor(ring_name(), {.producer = {.plan = {.read = {.counts_per_newton = 100}}}}),
      Error);
}

}  // namespace
}  // namespace pillarfield::viewer
