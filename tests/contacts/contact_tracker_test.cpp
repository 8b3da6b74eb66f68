#include "pillarfield/contact_tracker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pillarfield/contact_columns.h"
#include "pillarfield/status.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

using Ids = std::vector<std::uint64_t>;

constexpr double kPillarPitchMm = 1;

/// A patch of skin on which discs and boxes of loaded pillars are laid.
class Patch {
 public:
  Patch(std::uint32_t rows, std::uint32_t cols) : field_(rows, cols) {}

  Patch& box(int row, int col, int height, int width) {
    for (int r = row; r < row + height; ++r) {
      for (int c = col; c < col + width; ++c) load(r, c);
    }
    return *this;
  }

  Patch& disc(double row, double col, double radius) {
    for (int r = 0; r < static_cast<int>(field_.rows); ++r) {
      for (int c = 0; c < static_cast<int>(field_.cols); ++c) {
        if ((r - row) * (r - row) + (c - col) * (c - col) <= radius * radius) load(r, c);
      }
    }
    return *this;
  }

  [[nodiscard]] ForceFieldView view() const { return field_.view(); }

 private:
  void load(int row, int col) {
    const auto place = static_cast<std::size_t>(row) * field_.cols + static_cast<std::size_t>(col);
    field_.normal[place] = 1;
    field_.status[place] = status::kUsable;
  }

  ForceField field_;
};

Ids ids_of(const FrameContacts& frame) {
  Ids ids;
  for (const TrackedContact& contact : frame.contacts) ids.push_back(contact.track_id);
  return ids;
}

Ids ended_ids(const FrameContacts& frame) {
  Ids ids;
  for (const EndedContact& contact : frame.ended) ids.push_back(contact.track_id);
  return ids;
}

TEST(ContactTracker, ASlidingContactKeepsItsId) {
  ContactTracker tracker(kPillarPitchMm);
  for (int i = 0; i < 40; ++i) {
    const FrameContacts& frame = tracker.update(Patch(20, 60).disc(10, 6 + i, 4).view(), 0.5 * i);
    ASSERT_EQ(ids_of(frame), Ids{1}) << i;
    EXPECT_EQ(frame.contacts[0].first_time_s, 0);
    EXPECT_EQ(frame.contacts[0].age_s, 0.5 * i);
    EXPECT_FALSE(frame.contacts[0].parent);
    EXPECT_TRUE(frame.ended.empty());
  }
}

TEST(ContactTracker, AFrameWithContactsNeedsATime) {
  constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();
  ContactTracker tracker(kPillarPitchMm);
  EXPECT_TRUE(tracker.update(Patch(9, 9).view(), kNoTime).contacts.empty());
  EXPECT_EQ(
      core_test::message_of([&] { tracker.update(Patch(9, 9).disc(4, 4, 2).view(), kNoTime); }),
      "ContactTracker: a frame with contacts has the time nan; give finite seconds");
}

/// A frame and what must come of it: of each contact its id and its parent's, of each that ended
/// its id and that of the one it merged into; 0: none.
struct Step {
  Patch patch;
  Ids ids;
  Ids ended = {};
  Ids parents = {};
  Ids merged_into = {};
};

struct Story {
  const char* name;
  ContactOptions options;
  std::vector<Step> steps;
};

Patch bare() { return {30, 70}; }

const Story kStories[] = {
    {"a contact that jumps within reach keeps its id",
     {.reach_mm = 8},
     {{bare().disc(4, 4, 2), {1}},
      {bare().disc(4, 12, 2), {1}},
      {bare().disc(4, 20, 2), {1}},
      {bare().disc(4, 29, 2), {2}, {1}}}},
    {"without reach only shared pillars count",
     {.reach_mm = 0},
     {{bare().box(4, 4, 1, 2), {1}},
      {bare().box(4, 5, 1, 2), {1}},
      {bare().box(4, 7, 1, 2), {2}, {1}}}},
    {"of a split the larger part keeps the id: the left one",
     {},
     {{bare().box(2, 2, 4, 20), {1}},
      {bare().box(2, 2, 4, 12).box(2, 15, 4, 7), {1, 2}, {}, {0, 1}},
      {bare().box(2, 2, 4, 12).box(2, 15, 4, 7), {1, 2}, {}, {0, 1}}}},  // The parent stays known.
    {"of a split the larger part keeps the id: the right one",
     {},
     {{bare().box(2, 2, 4, 20), {1}},
      {bare().box(2, 2, 4, 7).box(2, 10, 4, 12), {2, 1}, {}, {1, 0}}}},
    {"a merged contact keeps the id that brought most pillars: the left one",
     {},
     {{bare().box(2, 2, 4, 12).box(2, 15, 4, 7), {1, 2}},
      {bare().box(2, 2, 4, 20), {1}, {2}, {}, {1}},
      {bare().box(2, 2, 4, 20), {1}}}},
    {"a merged contact keeps the id that brought most pillars: the right one",
     {},
     {{bare().box(2, 2, 4, 7).box(2, 10, 4, 12), {1, 2}},
      {bare().box(2, 2, 4, 20), {2}, {1}, {}, {2}}}},
    {"one that vanishes and returns is new",
     {},
     {{bare().disc(4, 4, 2), {1}}, {bare(), {}, {1}}, {bare().disc(4, 4, 2), {2}}}},
    {"shared pillars come before distance",  // The box at 15 shares a column with 2.
     {},
     {{bare().box(2, 4, 4, 4).box(2, 12, 4, 4), {1, 2}},
      {bare().box(2, 15, 4, 4).box(2, 9, 4, 2), {1, 2}}}},
    {"the nearest goes first",
     {},
     {{bare().box(4, 10, 2, 2), {1}}, {bare().box(4, 5, 2, 2).box(4, 14, 2, 2), {2, 1}}}},
    {"small contacts are not followed",
     {.minimum_pillars = 4},
     {{bare().box(1, 1, 1, 3), {}},
      {bare().box(1, 1, 2, 2), {1}},
      {bare().box(1, 1, 1, 3), {}, {1}}}},
};

TEST(ContactTracker, FollowsContactsThatJumpSplitMergeAndVanish) {
  for (const Story& story : kStories) {
    SCOPED_TRACE(story.name);
    ContactTracker tracker(kPillarPitchMm, story.options);
    std::map<std::uint64_t, double> began;
    double time_s = 0;
    for (const Step& step : story.steps) {
      const FrameContacts& frame = tracker.update(step.patch.view(), ++time_s);
      EXPECT_EQ(ids_of(frame), step.ids);
      EXPECT_EQ(ended_ids(frame), step.ended);
      Ids parents;
      for (const TrackedContact& contact : frame.contacts) {
        parents.push_back(contact.parent.value_or(0));
        EXPECT_EQ(contact.first_time_s, began.emplace(contact.track_id, time_s).first->second);
      }
      EXPECT_EQ(parents, step.parents.empty() ? Ids(step.ids.size()) : step.parents);
      Ids merged_into;
      for (const EndedContact& contact : frame.ended) {
        merged_into.push_back(contact.merged_into.value_or(0));
        EXPECT_EQ(contact.first_time_s, began.at(contact.track_id));
        EXPECT_EQ(contact.last_time_s, time_s - 1);
      }
      EXPECT_EQ(merged_into, step.merged_into.empty() ? Ids(step.ended.size()) : step.merged_into);
    }
  }
}

TEST(ContactTracker, MayJumpInAnyDirection) {
  for (int direction = 0; direction < 16; ++direction) {
    const double angle = direction * M_PI / 8;
    const double row = 30.5 + 9 * std::sin(angle);
    const double col = 30.5 + 9 * std::cos(angle);
    for (int shift = 0; shift < 12; ++shift) {
      ContactTracker tracker(kPillarPitchMm);
      tracker.update(Patch(75, 75).disc(30.5 + shift, 30.5, 2).view(), 0);
      const Patch jumped = Patch(75, 75).disc(row + shift, col, 2);
      EXPECT_EQ(ids_of(tracker.update(jumped.view(), 1)), Ids{1}) << direction << " " << shift;
    }
  }
}

/// Side by side, in opposite directions, by pillars that they share and by leaps.
TEST(ContactTracker, TwoThatPassEachOtherStayThemselves) {
  for (const int step : {1, 3, 6}) {
    ContactTracker tracker(kPillarPitchMm, {.reach_mm = 7});
    for (int i = 0; 10 + i * step <= 60; ++i) {
      const Patch patch = Patch(30, 70).disc(8, 10 + i * step, 2).disc(18, 60 - i * step, 2);
      EXPECT_EQ(ids_of(tracker.update(patch.view(), i)), (Ids{1, 2})) << step << " " << i;
    }
  }
}

TEST(ContactTracker, OneIntoManyAndManyIntoOne) {
  ContactTracker tracker(kPillarPitchMm);
  Patch teeth(20, 41);
  for (int col = 0; col < 41; col += 2) teeth.box(0, col, 20, 1);
  const Patch whole = Patch(20, 41).box(0, 0, 20, 41);
  EXPECT_EQ(tracker.update(teeth.view(), 0).contacts.size(), 21);
  const FrameContacts& merged = tracker.update(whole.view(), 1);
  EXPECT_EQ(ids_of(merged), Ids{1});
  EXPECT_EQ(merged.ended.size(), 20);
  for (const EndedContact& ended : merged.ended) EXPECT_EQ(ended.merged_into, 1);
  const FrameContacts& split = tracker.update(teeth.view(), 2);
  EXPECT_EQ(split.contacts.size(), 21);
  EXPECT_EQ(split.contacts[0].track_id, 1);
  for (std::size_t i = 1; i < 21; ++i) EXPECT_EQ(split.contacts[i].parent, 1);
}

TEST(ContactTracker, IdsAreNeverGivenTwice) {
  ContactTracker tracker(kPillarPitchMm);
  std::map<std::uint64_t, double> ended;
  for (int i = 0; i < 200; ++i) {
    Patch patch(30, 30);
    for (int k = 0; k < 5; ++k) patch.disc((i * 7 + k * 11) % 29, (i * i + k * 5) % 29, k % 3);
    const FrameContacts& frame = tracker.update(patch.view(), i);
    Ids ids = ids_of(frame);
    std::sort(ids.begin(), ids.end());
    EXPECT_TRUE(std::adjacent_find(ids.begin(), ids.end()) == ids.end());
    for (const EndedContact& contact : frame.ended) {
      EXPECT_TRUE(ended.emplace(contact.track_id, i).second);
      EXPECT_EQ(contact.last_time_s, i - 1);
    }
    for (const std::uint64_t id : ids) EXPECT_FALSE(ended.contains(id));
  }
}

/// Discs that slide, stick, slip in part, or show nothing, and specks: one of nearly all pillars of
/// the frame, some of a thousand, hundreds of a few.
ForceField many_contacts(int step) {
  ForceField field(220, 260);
  const auto load = [&](std::size_t row, std::size_t col, float ratio, float bears = 1) {
    const std::size_t place = row * field.cols + col;
    const std::size_t hash = place * 2654435761U % 1009;
    field.normal[place] = bears * (0.01F + 0.0001F * static_cast<float>(hash));
    field.shear_x[place] = ratio * field.normal[place] * 0.6F;
    field.shear_y[place] = ratio * field.normal[place] * 0.8F;
    field.status[place] = hash % 11 == 0 ? status::kAmbiguous | status::kSensel1 : status::kUsable;
  };
  const auto disc = [&](int row, int col, int radius, float ratio) {
    for (int r = row - radius; r <= row + radius; ++r) {
      for (int c = col - radius; c <= col + radius; ++c) {
        const int away = (r - row) * (r - row) + (c - col) * (c - col);
        if (away > radius * radius) continue;
        load(static_cast<std::size_t>(r), static_cast<std::size_t>(c),
             ratio * (c > col ? 1.0F : 0.9F + 0.01F * static_cast<float>(r % 3)),
             1.05F - static_cast<float>(away) / static_cast<float>(radius * radius));
      }
    }
  };
  disc(85, 85 + step, 80,
       step % 2 == 0 ? 0.7F : 0.0F);  // the bound of its friction is carried over
  for (int i = 0; i < 4; ++i) disc(25 + 45 * i, 220, 18, 0.3F * static_cast<float>(i));
  for (std::size_t col = 0; col < field.cols; col += 3) {
    for (std::size_t row = 180; row < field.rows; row += 4) {
      if (row > 210 || col < 180) load(row, col, 0.2F);
    }
  }
  return field;
}

void expect_same_bits(const ContactQuantities& actual, const ContactQuantities& expected) {
  for (const QuantityColumn& column : quantity_columns(true)) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(column.get(actual)),
              std::bit_cast<std::uint64_t>(column.get(expected)))
        << column.name;
  }
}

TEST(ContactTracker, FindsTheSameWithAnyNumberOfThreads) {
  for (const std::optional<double> friction : {std::optional<double>(), {0.6}}) {
    for (const std::uint32_t threads : {2U, 7U, 0U}) {
      ContactTracker alone(kPillarPitchMm, {.friction = {.given = friction}, .threads = 1});
      ContactTracker shared(kPillarPitchMm, {.friction = {.given = friction}, .threads = threads});
      bool bounded = false;
      for (int step = 0; step < 4; ++step) {
        const ForceField field = many_contacts(step);
        const FrameContacts& expected = alone.update(field.view(), step);
        const FrameContacts& actual = shared.update(field.view(), step);
        ASSERT_GT(expected.contacts.size(), 400U);
        ASSERT_EQ(ids_of(actual), ids_of(expected));
        for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
          expect_same_bits(actual.contacts[i].quantities, expected.contacts[i].quantities);
        }
        expect_same_bits(actual.total, expected.total);
        const FrictionSource source = expected.contacts[0].quantities.friction_source;
        bounded = bounded || source == FrictionSource::at_least;
      }
      EXPECT_EQ(bounded, !friction);
    }
  }
}

/// Forces of all magnitudes: their sums are rounded, so that their order shows.
TEST(ContactTracker, SumsALargeContactAlikeWithAnyNumberOfThreads) {
  ForceField field(150, 150);
  std::fill(field.status.begin(), field.status.end(), status::kUsable);
  for (std::size_t i = 0; i < field.elements(); ++i) {
    const int bits = static_cast<int>(i * 7919 % 6007);
    field.normal[i] = std::ldexp(1 + static_cast<float>(bits) / 6007, -(bits % 61));
    field.shear_x[i] = -0.3F * field.normal[i];
  }
  ContactTracker alone(kPillarPitchMm, {.threads = 1});
  const ContactQuantities expected = alone.update(field.view(), 0).contacts.at(0).quantities;
  for (const std::uint32_t threads : {2U, 5U}) {
    ContactTracker shared(kPillarPitchMm, {.threads = threads});
    expect_same_bits(shared.update(field.view(), 0).contacts.at(0).quantities, expected);
  }
}

TEST(ContactTracker, RefusesWhatMakesNoSense) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto says = [](auto action, const std::string& words) {
    const std::string message = core_test::message_of(action);
    EXPECT_NE(message.find(words), std::string::npos) << message;
  };
  for (const double pitch_mm : {0.0, -1.0, kNan}) {
    says([&] { const ContactTracker tracker(pitch_mm); }, "a pitch of");
  }
  for (const double friction : {0.0, -1.0, 101.0, kNan}) {
    says([&] { const ContactTracker tracker(1, {.friction = {.given = friction}}); }, "friction");
  }
  for (const double force_n : {-1.0, 1e7, kNan}) {
    says([&] { const ContactTracker tracker(1, {.noise_n = force_n}); }, "noise");
    says([&] { const ContactTracker tracker(1, {.hidden_n = force_n}); }, "hidden");
  }
  for (const double reach_mm : {-1.0, 1001.0, kNan}) {
    says([&] { const ContactTracker tracker(1, {.reach_mm = reach_mm}); }, "reach");
  }
  says([] { const ContactTracker tracker(1, {.threads = 1025}); }, "1025 threads");
  ContactTracker tracker(kPillarPitchMm);
  tracker.update(Patch(4, 5).view(), 0);
  const Patch other(5, 4);
  says([&] { tracker.update(other.view(), 1); }, "5 x 4 pillars after frames of 4 x 5");
  const Patch same(4, 5);
  ForceFieldView cut = same.view();
  cut.normal = {};
  says([&] { tracker.update(cut, 1); }, "0 forces for 4 x 5 pillars");
  for (const auto& [rows, cols] : {std::pair{5U, 5U}, {4U, 6U}}) {
    ContactLabels labels;
    labels.find(std::vector<std::uint8_t>(std::size_t{rows} * cols, status::kUsable), rows, cols);
    says([&] { tracker.update(same.view(), 1, {&labels, {}}); }, "of 4 x 5 pillars");
  }
  const ContactLabels none;
  const std::vector<ContactFriction> one(1);
  says(
      [&] {
        tracker.update(same.view(), 1, {&none, one});
      },
      "1 friction coefficients for 0 contacts");
}

}  // namespace
}  // namespace pillarfield
