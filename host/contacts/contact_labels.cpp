#include "pillarfield/contact_labels.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "pillarfield/error.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"
#include "solve/idle_blocks.h"

namespace pillarfield {
namespace {

static_assert(std::endian::native == std::endian::little,
              "words are taken apart from their low end");

std::uint64_t word_at(const std::uint8_t* bytes) {
  std::uint64_t word = 0;
  std::memcpy(&word, bytes, kWordBytes);
  return word;
}

/// Bit n says whether pillar n of eight is loaded.
unsigned loaded_of(std::uint64_t word) {
  // A usable bit carries into bit 4 of its byte; the product gathers these eight in the top byte.
  const std::uint64_t usable = word & (kEachByte * status::kUsable);
  const std::uint64_t carried = ((usable + kEachByte * status::kUsable) >> 4) & kEachByte;
  return static_cast<unsigned>((carried * 0x0102040810204080u) >> 56);
}

/// Eight pillars from column `col`, those past the row's end not loaded.
unsigned loaded_at(std::span<const std::uint8_t> row, std::size_t col) {
  if (col + kWordBytes <= row.size()) return loaded_of(word_at(row.data() + col));
  if (row.size() >= kWordBytes) {
    const std::uint64_t last = word_at(row.data() + row.size() - kWordBytes);
    return loaded_of(last >> (8 * (col + kWordBytes - row.size())));
  }
  std::uint64_t word = 0;
  std::memcpy(&word, row.data() + col, row.size() - col);
  return loaded_of(word);
}

/// So many bytes are looked at together where there is silence.
constexpr std::size_t kStride = 4 * kWordBytes;

bool is_idle(const std::uint8_t* bytes) {
  // Not a loop: that would not be unrolled.
  const std::uint64_t any = word_at(bytes) | word_at(bytes + kWordBytes) |
                            word_at(bytes + 2 * kWordBytes) | word_at(bytes + 3 * kWordBytes);
  return any == 0;
}

/// The row's end if all from `col` on is silent; else a column at or after it, a multiple of a word
/// from it, before which all is silent.
std::size_t skip_idle_bytes(std::span<const std::uint8_t> row, std::size_t col) {
  for (; col + kStride <= row.size(); col += kStride) {
    if (!is_idle(row.data() + col)) return col;
  }
  // What is left is less than a stride: with what is before it, it makes one.
  if (row.size() >= kStride && is_idle(row.data() + row.size() - kStride)) return row.size();
  return col;
}

/// Calls `use(first, end)` for each run of places that have what is looked for. `skip(at)` is a
/// place at or after `at` before which none has, and `bits(at)` tells of the eight from there; past
/// the last place none has.
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

/// Appends the runs of loaded pillars within a stretch of a row.
void append_runs(std::span<const std::uint8_t> row, const ContactRun& active,
                 std::vector<ContactRun>& runs) {
  const auto loaded = row.first(active.end);
  for_each_run(
      active.first, loaded.size(), [&](std::size_t col) { return skip_idle_bytes(loaded, col); },
      [&](std::size_t col) { return loaded_at(loaded, col); },
      [&](std::size_t first, std::size_t end) { runs.push_back(run_of(active.row, first, end)); });
}

/// Bit n says whether block n of eight, from `at` on, has no mark.
unsigned active_at(std::span<const std::uint8_t> marks, std::size_t at) {
  std::uint64_t word = kEachByte;  // past the last there is silence
  if (at + kWordBytes <= marks.size()) {
    word = word_at(marks.data() + at);
  } else {
    std::memcpy(&word, marks.data() + at, marks.size() - at);
  }
  return static_cast<unsigned>((~word & kEachByte) * 0x0102040810204080u >> 56);
}

/// Appends the stretches of a row of `cols` pillars whose blocks have no marks.
void append_active(std::uint32_t row, std::uint32_t cols, const IdleBlocks& silent,
                   std::vector<ContactRun>& stretches) {
  const std::size_t size = silent.pillars;
  const std::size_t skew = std::size_t{row} * cols % size;  // of the first block, in the row above
  const std::size_t blocks = (skew + cols + size - 1) / size;
  const auto marks = silent.flags.subspan(row * silent.stride, blocks);
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

/// Asks for the status of stretches: they are too far apart for a processor to guess.
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

/// The first run of the set that `run` is in. Halves the way there for those who ask later.
std::uint32_t first_of(std::vector<std::uint32_t>& parents, std::uint32_t run) {
  while (parents[run] != run) {
    parents[run] = parents[parents[run]];
    run = parents[run];
  }
  return run;
}

/// Joins two sets. Every parent comes before its children, so the first run stands for its set.
void join(std::vector<std::uint32_t>& parents, std::uint32_t a, std::uint32_t b) {
  a = first_of(parents, a);
  b = first_of(parents, b);
  parents[std::max(a, b)] = std::min(a, b);
}

/// Joins the runs of one row, [begin, end), with those of the row above it, [above, begin), that
/// they touch at a side or a corner.
void join_rows(std::span<const ContactRun> runs, std::size_t above, std::size_t begin,
               std::size_t end, std::vector<std::uint32_t>& parents) {
  for (std::size_t run = begin; run < end; ++run) {
    while (above < begin && runs[above].end < runs[run].first) ++above;
    for (std::size_t other = above; other < begin && runs[other].first <= runs[run].end; ++other) {
      join(parents, static_cast<std::uint32_t>(other), static_cast<std::uint32_t>(run));
    }
  }
}

}  // namespace

void ContactLabels::find(std::span<const std::uint8_t> status, std::uint32_t rows,
                         std::uint32_t cols) {
  find(status, rows, cols, {});
}

void ContactLabels::find(std::span<const std::uint8_t> status, std::uint32_t rows,
                         std::uint32_t cols, const IdleBlocks& silent) {
  if (status.size() != std::size_t{rows} * cols) {
    throw Error("ContactLabels::find",
                fmt::format("{} status bytes for {} x {} pillars", status.size(), rows, cols),
                "give one for each pillar");
  }
  active_.clear();
  for (std::uint32_t row = 0; row < rows; ++row) {
    if (silent.flags.empty()) {
      active_.push_back({row, 0, cols, 0});
    } else {
      append_active(row, cols, silent, active_);
    }
  }
  if (!silent.flags.empty()) prefetch(status, cols, active_);
  find_runs(status, cols);
  number_contacts();
  sort_runs();
}

/// Finds the runs in what is active, and joins those that touch.
void ContactLabels::find_runs(std::span<const std::uint8_t> status, std::uint32_t cols) {
  found_.clear();
  parents_.clear();
  std::size_t above = 0;  // where the runs of the row above begin
  std::uint32_t next_row = 0;
  for (std::size_t stretch = 0; stretch < active_.size();) {
    const std::uint32_t row = active_[stretch].row;
    const std::size_t begin = found_.size();
    if (row != next_row) above = begin;
    for (; stretch < active_.size() && active_[stretch].row == row; ++stretch) {
      append_runs(status.subspan(std::size_t{row} * cols, cols), active_[stretch], found_);
    }
    for (std::size_t run = begin; run < found_.size(); ++run) {
      parents_.push_back(static_cast<std::uint32_t>(run));
    }
    join_rows(found_, above, begin, found_.size(), parents_);
    above = begin;
    next_row = row + 1;
  }
}

/// First runs come in the order of the contacts' numbers, and before the others of their contact.
void ContactLabels::number_contacts() {
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

/// A counting sort, which keeps the order of runs within a contact.
void ContactLabels::sort_runs() {
  for (const ContactRun& run : found_) ++starts_[run.contact + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  next_.assign(starts_.begin(), starts_.end());
  runs_.resize(found_.size());
  for (const ContactRun& run : found_) runs_[next_[run.contact]++] = run;
}

}  // namespace pillarfield
