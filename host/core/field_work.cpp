#include "core/field_work.h"

#include <algorithm>
#include <cmath>
#include <cstring>

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
  return settings;
}

/// Of a contact at least one pillar in so many must be open for its evidence to be heard: fewer are
/// lone pillars at its edge, which bear little, and all of the contact would be searched for them.
constexpr std::uint32_t kLeastOpenShare = 64;

/// Counts of the open pillars of a run, and of those that their own readings determine, eight
/// status bytes at a time: is_open() and is_determined() of each.
struct RunCounts {
  static constexpr std::uint64_t kEachByte = 0x0101010101010101u;
  std::uint64_t open = 0;  ///< byte by byte
  std::uint64_t determined = 0;

  void add(std::uint64_t bits) {
    static_assert(status::kUsable == 15 && status::kAmbiguous == 1 << 4 &&
                  status::kSaturated == 1 << 5 && status::kInconsistent == 1 << 6);
    const std::uint64_t pairs = (bits & (5 * kEachByte)) + ((bits >> 1) & (5 * kEachByte));
    const std::uint64_t usable = (pairs & (3 * kEachByte)) + ((pairs >> 2) & (3 * kEachByte));
    const std::uint64_t are_two = usable >> 1 & ~usable;
    const std::uint64_t are_three_or_four = (usable + 5 * kEachByte) >> 3;
    open += are_two & bits >> 4 & ~(bits >> 5) & ~(bits >> 6) & kEachByte;
    determined += are_three_or_four & ~(bits >> 5) & kEachByte;
  }

  static std::uint32_t total(std::uint64_t counts) {
    constexpr std::uint64_t kEven = 0x00ff00ff00ff00ffu;
    const std::uint64_t pairs = (counts & kEven) + ((counts >> 8) & kEven);
    return static_cast<std::uint32_t>((pairs * 0x0001000100010001u) >> 48);
  }
};

/// So many words fit into the counts.
constexpr std::size_t kMostWords = 255;

}  // namespace

FieldWork::FieldWork(const SolverPlan& plan)
    : rows_(plan.skin.pillar_rows()),
      cols_(plan.skin.pillar_cols()),
      settings_(settings_of(plan)) {}

void FieldWork::find(std::span<const std::uint8_t> status) {
  map_.find(status, rows_, cols_);
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
    const std::uint32_t before = summary.open;
    add_counts(status.subspan(std::size_t{run.row} * cols_ + run.first, run.end - run.first),
               summary);
    if (summary.open != before) open_runs_.push_back(run);
    summary.pillars += run.end - run.first;
    summary.first_col = std::min(summary.first_col, run.first);
    summary.end_col = std::max(summary.end_col, run.end);
  }
  return summary;
}

void FieldWork::add_counts(std::span<const std::uint8_t> status, Summary& summary) {
  constexpr std::size_t kWord = sizeof(std::uint64_t);
  while (!status.empty()) {
    RunCounts counts;
    const auto piece = status.first(std::min(status.size(), kMostWords * kWord));
    for (std::size_t at = 0; at < piece.size(); at += kWord) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, piece.data() + at, std::min(kWord, piece.size() - at));
      counts.add(bits);
    }
    summary.open += RunCounts::total(counts.open);
    summary.resolved += RunCounts::total(counts.determined);
    status = status.subspan(piece.size());
  }
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
  if (asks && compact && matters && summary.resolved >= PF_LEAST_RESOLVED) {
    tiles_.push_back({runs.front().row, summary.first_col, rows, cols,
                      static_cast<std::uint32_t>(cells_), static_cast<std::uint32_t>(lines_),
                      static_cast<std::uint32_t>(runs.data() - map_.runs().data()),
                      static_cast<std::uint32_t>(runs.size())});
    cells_ += cells;
    lines_ += rows;
    return;
  }
  for (const ContactRun& run : open_runs_) {
    const std::size_t first = std::size_t{run.row} * cols_;
    for (std::size_t index = first + run.first; index < first + run.end; ++index) {
      if (maths::is_open(status[index])) alone_.push_back(static_cast<std::uint32_t>(index));
    }
  }
}

}  // namespace pillarfield
