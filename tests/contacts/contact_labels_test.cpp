#include "pillarfield/contact_labels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "pillarfield/status.h"
#include "tests/base/message.h"

namespace pillarfield {
namespace {

/// Status bytes by row; '#' is a loaded pillar, 'x' a missing and 's' a saturated one.
struct Mask {
  Mask(std::uint32_t mask_rows, std::uint32_t mask_cols)
      : rows(mask_rows), cols(mask_cols), status(std::size_t{rows} * cols) {}

  explicit Mask(const std::vector<std::string>& lines)
      : Mask(static_cast<std::uint32_t>(lines.size()),
             static_cast<std::uint32_t>(lines.empty() ? 0 : lines[0].size())) {
    for (std::uint32_t row = 0; row < rows; ++row) {
      for (std::uint32_t col = 0; col < cols; ++col) {
        set(row, col, lines[row][col] == '#');
        if (lines[row][col] == 'x') status[row * cols + col] = status::kInconsistent;
        if (lines[row][col] == 's') status[row * cols + col] = status::kSaturated;
      }
    }
  }

  /// The usable bit depends on the place, so that each of them is tried; so do the bits that must
  /// not count.
  void set(std::uint32_t row, std::uint32_t col, bool loaded) {
    const std::size_t place = std::size_t{row} * cols + col;
    const unsigned unusual = status::kAmbiguous | status::kFromNeighbours |
                             (loaded ? status::kInconsistent | status::kSaturated : 0U);
    const auto others = static_cast<std::uint8_t>(place % 5 == 0 ? unusual : 0U);
    const auto usable = static_cast<std::uint8_t>(loaded ? 1u << (place * 7 % 4) : 0u);
    status[place] = others | usable;
  }

  [[nodiscard]] bool loaded(std::int64_t row, std::int64_t col) const {
    if (row < 0 || col < 0 || row >= rows || col >= cols) return false;
    return (status[static_cast<std::size_t>(row * cols + col)] & status::kLoaded) != 0;
  }

  std::uint32_t rows;
  std::uint32_t cols;
  std::vector<std::uint8_t> status;
};

constexpr std::int64_t kNone = -1;

/// The contact of each pillar, by another way: from each pillar that is loaded and not yet
/// reached, row by row, flood its neighbours, kept on a stack.
std::vector<std::int64_t> flooded(const Mask& mask, std::int64_t& contacts) {
  std::vector<std::int64_t> label(mask.status.size(), kNone);
  contacts = 0;
  std::vector<std::pair<std::int64_t, std::int64_t>> stack;
  const auto reach = [&](std::int64_t row, std::int64_t col) {
    if (!mask.loaded(row, col)) return;
    std::int64_t& of_pillar = label[static_cast<std::size_t>(row * mask.cols + col)];
    if (of_pillar != kNone) return;
    of_pillar = contacts;
    stack.emplace_back(row, col);
  };
  for (std::int64_t row = 0; row < mask.rows; ++row) {
    for (std::int64_t col = 0; col < mask.cols; ++col) {
      reach(row, col);
      if (stack.empty()) continue;
      while (!stack.empty()) {
        const auto [r, c] = stack.back();
        stack.pop_back();
        for (std::int64_t near = 0; near < 9; ++near) reach(r + near / 3 - 1, c + near % 3 - 1);
      }
      ++contacts;
    }
  }
  return label;
}

/// The contact of each pillar by the runs, each listed once and in order.
std::vector<std::int64_t> mapped(const Mask& mask, const ContactLabels& labels) {
  std::vector<std::int64_t> label(mask.status.size(), kNone);
  std::size_t listed = 0;
  for (std::uint32_t contact = 0; contact < labels.contacts(); ++contact) {
    const auto runs = labels.runs(contact);
    EXPECT_FALSE(runs.empty());
    listed += runs.size();
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const ContactRun& run = runs[i];
      EXPECT_EQ(run.contact, contact);
      EXPECT_LT(run.first, run.end);
      EXPECT_TRUE(run.end <= mask.cols && run.row < mask.rows);
      const bool in_order = i == 0 || runs[i - 1].row < run.row ||
                            (runs[i - 1].row == run.row && runs[i - 1].end < run.first);
      EXPECT_TRUE(in_order) << "a gap parts two runs of a row";
      for (std::uint32_t col = run.first; col < run.end; ++col) {
        label[std::size_t{run.row} * mask.cols + col] = contact;
      }
    }
  }
  EXPECT_EQ(listed, labels.runs().size());
  return label;
}

/// Compares with the flood fill, which labels in the documented order. Returns the number of
/// contacts.
std::int64_t expect_as_flooded(const Mask& mask, ContactLabels& labels) {
  labels.find(mask.status, mask.rows, mask.cols);
  std::int64_t contacts = 0;
  const auto expected = flooded(mask, contacts);
  EXPECT_EQ(labels.contacts(), contacts);
  EXPECT_TRUE(mapped(mask, labels) == expected) << mask.rows << " x " << mask.cols;
  return contacts;
}

std::int64_t contacts_of(const Mask& mask) {
  ContactLabels labels;
  return expect_as_flooded(mask, labels);
}

/// A reproducible stream of numbers (splitmix64).
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next() {
    std::uint64_t mixed = state_ += 0x9e3779b97f4a7c15u;
    mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
    mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
    return mixed ^ (mixed >> 31);
  }

 private:
  std::uint64_t state_;
};

Mask random_mask(std::uint32_t rows, std::uint32_t cols, unsigned percent, std::uint64_t seed) {
  Mask mask(rows, cols);
  Numbers numbers(seed);
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t col = 0; col < cols; ++col) {
      mask.set(row, col, numbers.next() % 100 < percent);
    }
  }
  return mask;
}

TEST(ContactLabels, IsThatOfAFloodOnRandomMasks) {
  ContactLabels labels;  // reused: kept memory must not matter
  std::uint64_t seed = 0;
  for (const unsigned percent : {1u, 5u, 15u, 30u, 40u, 50u, 60u, 75u, 90u, 99u}) {
    for (const auto& [rows, cols] : {std::pair<std::uint32_t, std::uint32_t>{1, 200},
                                     {200, 1},
                                     {2, 7},
                                     {7, 8},
                                     {9, 9},
                                     {31, 33},
                                     {64, 64},
                                     {50, 131},
                                     {120, 97}}) {
      expect_as_flooded(random_mask(rows, cols, percent, ++seed), labels);
      if (HasFailure()) FAIL() << percent << " % of " << rows << " x " << cols;
    }
  }
}

TEST(ContactLabels, IsThatOfAFloodOnManySmallMasks) {
  ContactLabels labels;
  for (unsigned bits = 0; bits < 1u << 12; ++bits) {
    Mask mask(3, 4);
    for (std::uint32_t place = 0; place < 12; ++place) {
      mask.set(place / 4, place % 4, (bits >> place & 1u) != 0);
    }
    expect_as_flooded(mask, labels);
    if (HasFailure()) FAIL() << bits;
  }
}

TEST(ContactLabels, EveryStatusByteCountsByItsUsableAndSaturatedBits) {
  for (unsigned byte = 0; byte < 256; ++byte) {
    for (std::uint32_t col = 0; col < 19; ++col) {
      std::vector<std::uint8_t> bytes(19, status::kAmbiguous | status::kFromNeighbours);
      bytes[col] = static_cast<std::uint8_t>(byte);
      ContactLabels labels;
      labels.find(bytes, 1, 19);
      ASSERT_EQ(labels.contacts(), (byte & status::kLoaded) != 0 ? 1 : 0) << byte;
      for (const ContactRun& run : labels.runs()) ASSERT_EQ(run.first, col);
    }
  }
}

TEST(ContactLabels, OfNothingIsEmpty) {
  EXPECT_EQ(ContactLabels().contacts(), 0);
  EXPECT_EQ(contacts_of(Mask(0, 0)), 0);
  EXPECT_EQ(contacts_of(Mask(0, 5)), 0);
  EXPECT_EQ(contacts_of(Mask(5, 0)), 0);
  EXPECT_EQ(contacts_of(Mask(40, 70)), 0);
}

TEST(ContactLabels, ForgetsTheFrameBefore) {
  ContactLabels labels;
  expect_as_flooded(random_mask(50, 50, 30, 1), labels);
  EXPECT_EQ(expect_as_flooded(Mask(3, 90), labels), 0);
  EXPECT_TRUE(labels.runs().empty());
}

TEST(ContactLabels, MissingPillarsDoNotPartAContact) {
  const struct {
    std::vector<std::string> lines;
    std::uint32_t contacts;
  } cases[] = {
      {{"##x##", "##x##"}, 1},                            // a dead column
      {{"##xx#", "##xx#"}, 1},                            // two
      {{"##xxx##"}, 2},                                   // too wide
      {{"###", "xxx", "###"}, 1},                         // a dead row
      {{".#.x...", "xxxxxxx", "xxxxxxx", "...x.#."}, 2},  // the body is not above the other
      {{"##x##", "xxxxx", "##x##"}, 1},                   // row and column
      {{"#x...", "#x...", ".x...", ".x..#", ".x..#"}, 2},
      {{"#x.", ".x.", ".x#"}, 1},         // across a corner
      {{"#x.", ".x.", ".x.", ".x#"}, 2},  // two fingers beside a dead column
      {{"#x", ".x", "#x"}, 2},            // on one side of it
      {{"xxxxxxxx", "#xxxxxx#", "xxxxxxxx"}, 2},
      {{"##ss##"}, 1},  // saturated ones are loaded
      {{"ss", ".."}, 1},
      {{"#.x.#"}, 2},
      {{"x#", "#x"}, 1},
      {{"xx", "xx"}, 0},
      {{"#########x", "..........", "x#########"}, 2},
      {{"##x"}, 1},
      {{"##", "xx"}, 1},
  };
  for (const auto& [lines, contacts] : cases) {
    const Mask mask(lines);
    ContactLabels labels;
    labels.find(mask.status, mask.rows, mask.cols);
    EXPECT_EQ(labels.contacts(), contacts) << lines[0];
    for (const ContactRun& run : labels.runs()) {
      for (std::uint32_t col = run.first; col < run.end; ++col) {
        EXPECT_TRUE(mask.loaded(run.row, col));
      }
    }
  }
}

TEST(ContactLabels, SizesMustAgree) {
  const std::vector<std::uint8_t> status(12);
  ContactLabels labels;
  const std::string message = core_test::message_of([&] { labels.find(status, 3, 5); });
  EXPECT_NE(message.find("12 status bytes for 3 x 5 pillars"), std::string::npos) << message;
}

}  // namespace
}  // namespace pillarfield
