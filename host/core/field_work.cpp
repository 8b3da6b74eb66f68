#include "core/field_work.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/status_word.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

namespace maths = single_precision;

/// A box may be so many times as large as its pillars are many: else thin contacts that enclose
/// each other would take memory beyond all bounds. Small ones may be as they like.
constexpr std::size_t kMostCellsPerPillar = 16;
constexpr std::size_t kSmallBox = 1024;

maths::FieldSettings settings_of(const SolverPlan& plan) {
  const double newtons = 1 / plan.skin.counts_per_newton;
  const double noise =
      plan.noise_counts || !plan.calibration.noise.empty() ? reading_noise(plan) : 0;
  maths::FieldSettings settings{};
  settings.noise = static_cast<float>(noise * newtons);
  settings.quiet =
      static_cast<float>(std::max(2 * plan.skin.threshold_counts, 8 * noise) * newtons);
  settings.friction = static_cast<float>(plan.field.friction.value_or(0));
  settings.slips = plan.field.slips ? 1U : 0U;
  settings.shape = plan.field.shape ? 1U : 0U;
  settings.slip = plan.field.slip ? 1U : 0U;
  settings.sweeps = static_cast<std::uint32_t>(plan.field.sweeps);
  settings.segment_point = static_cast<float>(plan.segment_point);
  return settings;
}

static_assert(std::endian::native == std::endian::little,
              "words are taken apart from their low end");
static_assert(status::kUsable == 15 && status::kAmbiguous == 1 << 4 &&
              status::kSaturated == 1 << 5 && status::kInconsistent == 1 << 6);

/// How many sensels are usable, byte by byte.
std::uint64_t usable_of(std::uint64_t bits) {
  const std::uint64_t pairs = (bits & (5 * kEachByte)) + ((bits >> 1) & (5 * kEachByte));
  return (pairs & (3 * kEachByte)) + ((pairs >> 2) & (3 * kEachByte));
}

/// maths::is_open() of eight status bytes, in bit 0 of each.
std::uint64_t open_of(std::uint64_t bits) {
  const std::uint64_t usable = usable_of(bits);
  const std::uint64_t two = (usable >> 1) & ~usable;
  return two & (bits >> 4) & ~(bits >> 5) & ~(bits >> 6) & kEachByte;
}

/// maths::is_determined() likewise.
std::uint64_t determined_of(std::uint64_t bits) {
  const std::uint64_t three_or_four = (usable_of(bits) + 5 * kEachByte) >> 3;
  return three_or_four & ~(bits >> 5) & kEachByte;
}

/// Calls `use(word, place)` for eight status bytes after the other; past the end there are zeros.
template <class Use>
void for_each_word(std::span<const std::uint8_t> status, const Use& use) {
  std::uint64_t word = 0;
  std::size_t at = 0;
  for (; at + kWordBytes <= status.size(); at += kWordBytes) {
    std::memcpy(&word, status.data() + at, kWordBytes);
    use(word, at);
  }
  const std::size_t left = status.size() - at;
  if (left == 0) return;
  if (at == 0) {
    word = 0;
    std::memcpy(&word, status.data(), left);
  } else {
    // Not so few bytes by themselves: to copy a number that is not known takes a call.
    std::memcpy(&word, status.data() + status.size() - kWordBytes, kWordBytes);
    word >>= 8 * (kWordBytes - left);
  }
  use(word, at);
}

std::uint32_t total_of(std::uint64_t counts) {
  constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffu;
  const std::uint64_t pairs = (counts & kEven) + ((counts >> 8) & kEven);
  return static_cast<std::uint32_t>((pairs * 0x0001000100010001u) >> 48);
}

/// So many status bytes can be counted byte by byte.
constexpr std::size_t kMostCounted = 255 * kWordBytes;

/// How many of `of` there are in a run, eight bytes at a time; words with none of `needed` have
/// none.
template <class Of>
std::uint32_t count_of(std::span<const std::uint8_t> status, std::uint8_t needed, const Of& of) {
  std::uint32_t count = 0;
  while (!status.empty()) {
    const auto piece = status.first(std::min(status.size(), kMostCounted));
    std::uint64_t counts = 0;
    for_each_word(piece, [&](std::uint64_t word, std::size_t) {
      if ((word & needed * kEachByte) != 0) counts += of(word);
    });
    count += total_of(counts);
    status = status.subspan(piece.size());
  }
  return count;
}

}  // namespace

FieldWork::FieldWork(const SolverPlan& plan)
    : rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      settings_(settings_of(plan)) {}

void FieldWork::find(std::span<const std::uint8_t> status, const SilentBlocks& silent) {
  map_.find(status, rows_, cols_, silent);
  tiles_.clear();
  alone_.clear();
  cells_ = 0;
  lines_ = 0;
  for (std::uint32_t contact = 0; contact < map_.contacts(); ++contact) {
    add_contact(contact, status);
  }
}

/// Notes also which runs have open pillars.
FieldWork::Summary FieldWork::summarise(std::span<const ContactRun> runs,
                                        std::span<const std::uint8_t> status) {
  Summary summary;
  open_runs_.clear();
  for (const ContactRun& run : runs) {
    const std::uint32_t open = count_of(status_of(run, status), status::kAmbiguous,
                                        [](std::uint64_t word) { return open_of(word); });
    if (open != 0) open_runs_.push_back(run);
    summary.open += open;
    summary.pillars += run.end - run.first;
    summary.first_col = std::min(summary.first_col, run.first);
    summary.end_col = std::max(summary.end_col, run.end);
  }
  return summary;
}

bool FieldWork::has_evidence(std::span<const ContactRun> runs,
                             std::span<const std::uint8_t> status) const {
  std::uint32_t determined = 0;
  for (const ContactRun& run : runs) {
    determined += count_of(status_of(run, status), status::kUsable,
                           [](std::uint64_t word) { return determined_of(word); });
    if (determined >= PF_LEAST_RESOLVED) return true;
  }
  return false;
}

std::span<const std::uint8_t> FieldWork::status_of(const ContactRun& run,
                                                   std::span<const std::uint8_t> status) const {
  return status.subspan(std::size_t{run.row} * cols_ + run.first, run.end - run.first);
}

void FieldWork::add_alone(std::span<const std::uint8_t> status, std::size_t first) {
  for_each_word(status, [&](std::uint64_t word, std::size_t at) {
    for (std::uint64_t open = open_of(word); open != 0; open &= open - 1) {
      const std::size_t byte = static_cast<std::size_t>(std::countr_zero(open)) / 8;
      alone_.push_back(static_cast<std::uint32_t>(first + at + byte));
    }
  });
}

void FieldWork::add_contact(std::uint32_t contact, std::span<const std::uint8_t> status) {
  const std::span<const ContactRun> runs = map_.runs(contact);
  const Summary summary = summarise(runs, status);
  if (summary.open == 0) return;
  const std::uint32_t rows = runs.back().row - runs.front().row + 1;
  const std::uint32_t cols = summary.end_col - summary.first_col;
  const std::size_t cells = (std::size_t{rows} + 2) * (cols + 2);
  const bool compact = cells <= std::max(kSmallBox, kMostCellsPerPillar * summary.pillars);
  const bool asks = settings_.slips == 0 && (settings_.shape != 0 || settings_.slip != 0);
  const bool matters = kLeastOpenShare * summary.open >= summary.pillars;
  if (asks && compact && matters && has_evidence(runs, status)) {
    tiles_.push_back({runs.front().row, summary.first_col, rows, cols,
                      static_cast<std::uint32_t>(cells_), static_cast<std::uint32_t>(lines_),
                      static_cast<std::uint32_t>(runs.data() - map_.runs().data()),
                      static_cast<std::uint32_t>(runs.size())});
    cells_ += cells;
    lines_ += rows;
    return;
  }
  for (const ContactRun& run : open_runs_) {
    add_alone(status_of(run, status), std::size_t{run.row} * cols_ + run.first);
  }
}

}  // namespace pillarfield
