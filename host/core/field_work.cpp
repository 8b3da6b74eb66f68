#include "core/field_work.h"

#include <algorithm>
#include <array>
#include <cmath>

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

/// By status byte what to add up, to count open pillars in the lower half of a word and those that
/// their own readings determine in the upper half.
using StatusCounts = std::array<std::uint64_t, 256>;
constexpr int kDeterminedShift = 32;

StatusCounts make_counts() {
  StatusCounts counts{};
  for (std::size_t bits = 0; bits < counts.size(); ++bits) {
    const auto status = static_cast<std::uint8_t>(bits);
    counts.at(bits) = std::uint64_t{maths::is_open(status) ? 1U : 0U} |
                      std::uint64_t{maths::is_determined(status) ? 1U : 0U} << kDeterminedShift;
  }
  return counts;
}

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
  static const StatusCounts counts_of = make_counts();
  Summary summary;
  std::uint64_t all = 0;
  open_runs_.clear();
  for (const ContactRun& run : runs) {
    const std::uint8_t* const row = status.data() + std::size_t{run.row} * cols_;
    std::uint64_t counts = 0;
    for (std::uint32_t col = run.first; col < run.end; ++col) counts += counts_of[row[col]];
    if (static_cast<std::uint32_t>(counts) != 0) open_runs_.push_back(run);
    all += counts;
    summary.pillars += run.end - run.first;
    summary.first_col = std::min(summary.first_col, run.first);
    summary.end_col = std::max(summary.end_col, run.end);
  }
  summary.open = static_cast<std::uint32_t>(all);
  summary.resolved = static_cast<std::uint32_t>(all >> kDeterminedShift);
  return summary;
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
