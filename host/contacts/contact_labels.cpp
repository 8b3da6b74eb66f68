#include "pillarfield/contact_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"
#include "solve/idle_blocks.h"

namespace pillarfield {
namespace {

static_assert(std::endian::native == std::endian::little,
              "bit positions in words are those of little-endian bytes");

std::uint64_t word_at(const std::uint8_t* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, kWordBytes);
  return word;
}

/// 1 in each byte of a loaded pillar: a set bit carries into bit 6.
std::uint64_t loaded_bytes(std::uint64_t word) {
  constexpr std::uint64_t kSix = 63;
  return (((word & (kEachByte * status::kLoaded)) + kEachByte * kSix) >> 6) & kEachByte;
}

/// Bit n is that of byte n, which is 0 or 1.
unsigned bits_of(std::uint64_t bytes) {
  return static_cast<unsigned>((bytes * 0x0102040810204080u) >> 56);
}

/// The status of eight pillars from column `col`; zero past the row's end.
std::uint64_t eight_from(std::span<const std::uint8_t> row, std::size_t col) {
  if (col + kWordBytes <= row.size()) return word_at(row.data() + col);
  if (row.size() >= kWordBytes) {
    const std::uint64_t last = word_at(row.data() + row.size() - kWordBytes);
    return last >> (8 * (col + kWordBytes - row.size()));
  }
  std::uint64_t word = 0;
  std::memcpy(&word, row.data() + col, row.size() - col);
  return word;
}

/// Pillars that a contact may bridge, since their load is unknown: those of missing sensels.
constexpr unsigned kUnknownLoad = status::kInconsistent;
bool may_be_loaded(std::uint8_t status) {
  return (status & kUnknownLoad) != 0 && (status & status::kLoaded) == 0;
}

/// Bit n is set if pillar n of eight may be loaded.
unsigned may_be_loaded_of(std::uint64_t word) {
  return bits_of((word >> std::countr_zero(kUnknownLoad)) & kEachByte & ~loaded_bytes(word));
}

/// The widest gap that a contact bridges: two dead lines side by side.
constexpr std::uint32_t kWidestGap = 2;

/// Status bytes that are tested at a time.
constexpr std::size_t kStride = 4 * kWordBytes;

/// All bits of kStride status bytes.
std::uint64_t bits_in(const std::uint8_t* bytes) {
  // Not a loop: that would not be unrolled.
  return word_at(bytes) | word_at(bytes + kWordBytes) | word_at(bytes + 2 * kWordBytes) |
         word_at(bytes + 3 * kWordBytes);
}

/// A column at or after `col` before which no pillar is loaded: the row's end, or a whole number of
/// words from `col`. Adds the bits that it meets.
std::size_t skip_unloaded(std::span<const std::uint8_t> row, std::size_t col, std::uint64_t& met) {
  const auto is_unloaded = [&](std::size_t at) {
    const std::uint64_t bits = bits_in(row.data() + at);
    met |= bits;
    return (bits & kEachByte * status::kLoaded) == 0;
  };
  for (; col + kStride <= row.size(); col += kStride) {
    if (!is_unloaded(col)) return col;
  }
  // Fewer than kStride bytes are left: test the last kStride bytes of the row.
  if (row.size() >= kStride && is_unloaded(row.size() - kStride)) return row.size();
  return col;
}

/// Calls `use(first, end)` for each run of set places in [first, places). `skip(at)` returns a
/// place at or after `at` before which none is set; `bits(at)` returns the eight places from `at`
/// as bits, zero past the last place.
template <class Skip, class Bits, class Use>
void for_each_run(std::size_t first, std::size_t places, const Skip& skip, const Bits& bits,
                  const Use& use) {
  bool inside = false;
  std::size_t begin = 0;
  for (std::size_t at = first; at < places; at += kWordBytes) {
    if (!inside) at = skip(at);
    if (at >= places) break;
    const unsigned found = bits(at);
    // A bit where a place differs from the one before it.
    unsigned changes = (found ^ (found << 1 | (inside ? 1u : 0u))) & 0xffu;
    for (; changes != 0; changes &= changes - 1) {
      const std::size_t change = at + static_cast<std::size_t>(std::countr_zero(changes));
      if (inside) {
        use(begin, change);
      } else {
        begin = change;
      }
      inside = !inside;
    }
  }
  if (inside) use(begin, places);
}

ContactRun run_of(std::size_t row, std::size_t first, std::size_t end) {
  return {static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(first),
          static_cast<std::uint32_t>(end), 0};
}

/// Appends the runs of loaded pillars within the columns of `active`; adds the bits that it meets.
void append_runs(std::span<const std::uint8_t> row, const ContactRun& active,
                 std::vector<ContactRun>& runs, std::uint64_t& met) {
  const auto loaded = row.first(active.end);
  for_each_run(
      active.first, loaded.size(), [&](std::size_t col) { return skip_unloaded(loaded, col, met); },
      [&](std::size_t col) {
        const std::uint64_t word = eight_from(loaded, col);
        met |= word;
        return bits_of(loaded_bytes(word));
      },
      [&](std::size_t first, std::size_t end) { runs.push_back(run_of(active.row, first, end)); });
}

/// Bit n is set if block `at` + n is not idle.
unsigned active_at(std::span<const std::uint8_t> marks, std::size_t at) {
  std::uint64_t word = kEachByte;  // blocks past the last are idle
  if (at + kWordBytes <= marks.size()) {
    word = word_at(marks.data() + at);
  } else {
    std::memcpy(&word, marks.data() + at, marks.size() - at);
  }
  return bits_of(~word & kEachByte);
}

/// Appends the column ranges of a row of `cols` pillars whose blocks are not idle.
void append_active(std::uint32_t row, std::uint32_t cols, const IdleBlocks& idle,
                   std::vector<ContactRun>& stretches) {
  const std::size_t size = idle.pillars;
  const std::size_t skew =
      std::size_t{row} * cols % size;  // pillars of the first block in the row above
  const std::size_t blocks = (skew + cols + size - 1) / size;
  if (row * idle.stride + blocks > idle.flags.size()) {
    throw Error("ContactLabels::find", "the idle blocks are those of a smaller frame",
                "give Processor::contacts() of the same frame");
  }
  const auto marks = idle.flags.subspan(row * idle.stride, blocks);
  const auto skip = [&](std::size_t at) {
    while (at + kWordBytes <= blocks && word_at(marks.data() + at) == kEachByte) at += kWordBytes;
    return at;
  };
  for_each_run(
      0, blocks, skip, [&](std::size_t at) { return active_at(marks, at); },
      [&](std::size_t first, std::size_t end) {
        stretches.push_back(run_of(row, std::max(first * size, skew) - skew,
                                   std::min<std::size_t>(end * size - skew, cols)));
      });
}

/// Prefetches status bytes: stretches lie too far apart for hardware prefetching.
void prefetch(std::span<const std::uint8_t> status, std::uint32_t cols,
              std::span<const ContactRun> stretches) {
#if defined(__GNUC__)
  constexpr std::uint32_t kLine = 64;
  for (const ContactRun& stretch : stretches) {
    const std::uint8_t* const row = status.data() + std::size_t{stretch.row} * cols;
    for (std::uint32_t col = stretch.first; col < stretch.end + kLine - 1; col += kLine) {
      __builtin_prefetch(row + std::min(col, stretch.end - 1));
    }
  }
#endif
}

/// Union-find with path halving: the first run of the set that contains `run`.
std::uint32_t first_of(std::vector<std::uint32_t>& parents, std::uint32_t run) {
  while (parents[run] != run) {
    parents[run] = parents[parents[run]];
    run = parents[run];
  }
  return run;
}

/// Joins two sets. A parent precedes its children, so the root is the first run of its set.
void join(std::vector<std::uint32_t>& parents, std::uint32_t a, std::uint32_t b) {
  a = first_of(parents, a);
  b = first_of(parents, b);
  parents[std::max(a, b)] = std::min(a, b);
}

/// Joins the runs of one row, [begin, end), with touching runs of the row above, [above, begin);
/// corners touch.
void join_rows(std::span<const ContactRun> runs, std::size_t above, std::size_t begin,
               std::size_t end, std::vector<std::uint32_t>& parents) {
  for (std::size_t run = begin; run < end; ++run) {
    while (above < begin && runs[above].end < runs[run].first) ++above;
    for (std::size_t other = above; other < begin && runs[other].first <= runs[run].end; ++other) {
      join(parents, static_cast<std::uint32_t>(other), static_cast<std::uint32_t>(run));
    }
  }
}

/// Joins runs with those that lie behind a gap to their right or below them.
class GapJoiner {
 public:
  GapJoiner(std::span<const std::uint8_t> status, std::uint32_t cols,
            std::span<const ContactRun> runs, std::vector<std::uint32_t>& parents)
      : status_(status), cols_(cols), runs_(runs), parents_(parents) {}

  void join(std::uint32_t run) const {
    const auto& [row, first, end, contact] = runs_[run];
    join_behind(run, row, end, false);
    const std::size_t below = (std::size_t{row} + 1) * cols_;
    if (below >= status_.size()) return;
    const auto under = status_.subspan(below, end);
    for (std::size_t col = first; col < end; col += kWordBytes) {
      for (unsigned gaps = may_be_loaded_of(eight_from(under, col)); gaps != 0; gaps &= gaps - 1) {
        const auto gap = static_cast<std::uint32_t>(std::countr_zero(gaps));
        join_behind(run, row + 1, static_cast<std::uint32_t>(col) + gap, true);
      }
    }
  }

 private:
  /// Joins the run with that at a place, if any; rows and columns below 0 are 2^32 - 1.
  void join_at(std::uint32_t run, std::uint32_t row, std::uint32_t col) const {
    const auto after = std::ranges::upper_bound(
        runs_, std::pair(row, col), {},
        [](const ContactRun& each) { return std::pair(each.row, each.first); });
    if (after == runs_.begin() || after[-1].row != row || after[-1].end <= col) return;
    pillarfield::join(parents_, run, static_cast<std::uint32_t>(after - runs_.begin() - 1));
  }

  /// From the first place of a gap, whose length is at most kWidestGap.
  void join_behind(std::uint32_t run, std::uint32_t row, std::uint32_t col, bool is_below) const {
    std::uint32_t length = 0;
    const auto is_gap = [&] {
      const std::size_t place = std::size_t{row} * cols_ + col;
      return col < cols_ && place < status_.size() && may_be_loaded(status_[place]);
    };
    for (; length <= kWidestGap && is_gap(); ++length) is_below ? ++row : ++col;
    if (length == 0 || length > kWidestGap || col >= cols_) return;
    for (std::uint32_t side = 0; side <= 2 * length + 2; ++side) {
      const std::uint32_t aside = side - length - 1;
      is_below ? join_at(run, row, col + aside) : join_at(run, row + aside, col);
    }
  }

  std::span<const std::uint8_t> status_;
  std::uint32_t cols_;
  std::span<const ContactRun> runs_;
  std::vector<std::uint32_t>& parents_;
};

}  // namespace

void ContactLabels::find(std::span<const std::uint8_t> status, std::uint32_t rows,
                         std::uint32_t cols) {
  find(status, rows, cols, {});
}

void ContactLabels::find(std::span<const std::uint8_t> status, std::uint32_t rows,
                         std::uint32_t cols, const IdleBlocks& idle) {
  if (status.size() != std::size_t{rows} * cols) {
    throw Error("ContactLabels::find",
                fmt::format("{} status bytes for {} x {} pillars", status.size(), rows, cols),
                "give one for each pillar");
  }
  active_.clear();
  for (std::uint32_t row = 0; row < rows; ++row) {
    if (idle.flags.empty()) {
      active_.push_back({row, 0, cols, 0});
    } else {
      append_active(row, cols, idle, active_);
    }
  }
  if (!idle.flags.empty()) prefetch(status, cols, active_);
  find_runs(status, cols);
  label_contacts();
  sort_runs();
}

/// Finds the runs of loaded pillars in active_ and joins those that touch, or have a gap between.
void ContactLabels::find_runs(std::span<const std::uint8_t> status, std::uint32_t cols) {
  found_.clear();
  parents_.clear();
  std::uint64_t met = 0;
  std::size_t above = 0;  // first run of the row above
  std::uint32_t next_row = 0;
  for (std::size_t stretch = 0; stretch < active_.size();) {
    const std::uint32_t row = active_[stretch].row;
    const std::size_t begin = found_.size();
    if (row != next_row) above = begin;
    for (; stretch < active_.size() && active_[stretch].row == row; ++stretch) {
      append_runs(status.subspan(std::size_t{row} * cols, cols), active_[stretch], found_, met);
    }
    for (std::size_t run = begin; run < found_.size(); ++run) {
      parents_.push_back(static_cast<std::uint32_t>(run));
    }
    join_rows(found_, above, begin, found_.size(), parents_);
    above = begin;
    next_row = row + 1;
  }
  if ((met & kEachByte * kUnknownLoad) == 0) return;
  const GapJoiner gaps(status, cols, found_, parents_);
  for (std::uint32_t run = 0; run < found_.size(); ++run) gaps.join(run);
}

/// Labels contacts by their first runs, in order. A contact's first run precedes its others.
void ContactLabels::label_contacts() {
  starts_.assign(1, 0);
  for (std::size_t run = 0; run < found_.size(); ++run) {
    if (parents_[run] == run) {
      found_[run].contact = static_cast<std::uint32_t>(starts_.size() - 1);
      starts_.push_back(0);
    } else {
      found_[run].contact = found_[parents_[run]].contact;
    }
  }
}

/// Sorts the runs by label: a stable counting sort.
void ContactLabels::sort_runs() {
  for (const ContactRun& run : found_) ++starts_[run.contact + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  next_.assign(starts_.begin(), starts_.end());
  runs_.resize(found_.size());
  for (const ContactRun& run : found_) runs_[next_[run.contact]++] = run;
}

}  // namespace pillarfield
