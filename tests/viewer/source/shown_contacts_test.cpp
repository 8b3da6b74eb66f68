// Contacts of shown fields: extents, order and ids.

#include "viewer/source/shown_contacts.h"

#include <gtest/gtest.h>

#include "pillarfield/error.h"
#include "tests/viewer/source/touched_field.h"

namespace pillarfield::viewer {
namespace {

constexpr double kContactPitch = 1.25;

void expect_rect(const PillarRect& rect, const PillarRect& expected) {
  EXPECT_EQ(rect.row_begin, expected.row_begin);
  EXPECT_EQ(rect.row_end, expected.row_end);
  EXPECT_EQ(rect.col_begin, expected.col_begin);
  EXPECT_EQ(rect.col_end, expected.col_end);
}

std::vector<std::uint64_t> shown_ids_of(const ShownContacts& contacts) {
  std::vector<std::uint64_t> ids;
  for (const TrackedContact& contact : contacts.found.contacts) ids.push_back(contact.track_id);
  return ids;
}

TEST(ShownContacts, HaveTheExtentOfTheirPillarsWhateverTheShape) {
  // An L whose first run lies right of its last, and a pillar inside its corner.
  const ShownField field =
      touched_field(0, 20, 30, {{{2, 9, 12, 14}}, {{8, 9, 4, 12}}, {{3, 4, 5, 6}}});
  const ShownContacts contacts = FieldContacts(kContactPitch).contacts_of(field);
  ASSERT_EQ(contacts.extents.size(), 2U);
  expect_rect(contacts.extents[0], {2, 9, 4, 14});
  expect_rect(contacts.extents[1], {3, 4, 5, 6});
}

TEST(ShownContacts, TheHeaviestComesFirst) {
  const ShownField field = touched_field(
      0, 20, 30, {{{1, 3, 1, 3}, 1}, {{5, 7, 5, 7}, 3}, {{9, 11, 9, 11}, 2}, {{15, 17, 2, 4}, 3}});
  const ShownContacts contacts = FieldContacts(kContactPitch).contacts_of(field);
  EXPECT_EQ(contacts.heaviest, (std::vector<std::size_t>{1, 3, 2, 0}));
  EXPECT_DOUBLE_EQ(contacts.found.total.normal_n, 4 * (1 + 3 + 2 + 3));
}

TEST(ShownContacts, ANumberThatTheStatusLacksIsAnError) {
  ContactLabels map;
  const ShownField field = touched_field(0, 20, 30, {{{1, 3, 1, 3}}});
  map.find(field.forces.status, 20, 30);
  FrameContacts found;
  found.contacts.emplace_back().label = 1;
  EXPECT_THROW(static_cast<void>(with_extents(found, map)), Error);
}

TEST(FieldContacts, FollowsOnwardsAlsoPastFramesLeftOut) {
  FieldContacts watch(kContactPitch);
  const Touch left{{2, 6, 2, 6}};
  const Touch right{{12, 16, 20, 24}};
  EXPECT_EQ(shown_ids_of(watch.contacts_of(touched_field(3, 20, 30, {left}))),
            (std::vector<std::uint64_t>{1}));
  EXPECT_EQ(shown_ids_of(watch.contacts_of(touched_field(4, 20, 30, {left, right}))),
            (std::vector<std::uint64_t>{1, 2}));
  EXPECT_EQ(shown_ids_of(watch.contacts_of(touched_field(9, 20, 30, {right}))),
            (std::vector<std::uint64_t>{2}));
  // The same field once more, as while paused.
  EXPECT_EQ(shown_ids_of(watch.contacts_of(touched_field(9, 20, 30, {right}))),
            (std::vector<std::uint64_t>{2}));
}

}  // namespace
}  // namespace pillarfield::viewer
