#include "cli/parts/launcher.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdlib>
#include <string_view>

#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

/// A launcher that gives rank and size.
struct RankVariables {
  const char* rank;
  const char* size;
};
/// Slurm sets the second size in batch scripts too, where only one process runs.
constexpr std::array kRanks = {
    RankVariables{"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"},
    RankVariables{"PMI_RANK", "PMI_SIZE"},
    RankVariables{"SLURM_PROCID", "SLURM_STEP_NUM_TASKS"},
    RankVariables{"SLURM_PROCID", "SLURM_NTASKS"},
};

/// A queue that numbers the tasks of an array job from `first` in steps to `last`.
struct ArrayVariables {
  const char* task;
  const char* first;
  const char* last;
  const char* step;
};
constexpr std::array kArrays = {
    ArrayVariables{"SLURM_ARRAY_TASK_ID", "SLURM_ARRAY_TASK_MIN", "SLURM_ARRAY_TASK_MAX",
                   "SLURM_ARRAY_TASK_STEP"},
    ArrayVariables{"SGE_TASK_ID", "SGE_TASK_FIRST", "SGE_TASK_LAST", "SGE_TASK_STEPSIZE"},
};

constexpr const char* kMend = "give --part K/N";

/// The number in a variable of the environment; nothing if it is unset or no number, as Grid
/// Engine's "undefined".
std::optional<std::uint64_t> number_in(const char* variable) {
  const char* const text = std::getenv(variable);
  if (text == nullptr) return std::nullopt;
  const std::string_view digits = text;
  constexpr std::uint64_t kMost = 1'000'000'000;
  std::uint64_t value = 0;
  const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool is_number = parsed.ec == std::errc{} && parsed.ptr == digits.data() + digits.size();
  return is_number && value <= kMost ? std::optional(value) : std::nullopt;
}

Rank checked(Rank rank) {
  if (rank.rank < rank.size) return rank;
  throw Error(rank.variable, fmt::format("rank {} of {} does not exist", rank.rank, rank.size),
              kMend);
}

std::optional<Rank> rank_of_process() {
  for (const RankVariables& each : kRanks) {
    const auto rank = number_in(each.rank);
    const auto size = number_in(each.size);
    if (rank && size) return checked({*rank, *size, each.rank});
  }
  return std::nullopt;
}

std::optional<Rank> rank_of_array_task() {
  for (const ArrayVariables& each : kArrays) {
    const auto task = number_in(each.task);
    const auto first = number_in(each.first);
    const auto last = number_in(each.last);
    if (!task || !first || !last) continue;
    const std::uint64_t step = number_in(each.step).value_or(1);
    if (step == 0 || *task < *first || *last < *task || (*task - *first) % step != 0) {
      throw Error(each.task, fmt::format("task {} is not in {} to {}", *task, *first, *last),
                  kMend);
    }
    return checked({(*task - *first) / step, (*last - *first) / step + 1, each.task});
  }
  return std::nullopt;
}

}  // namespace

std::optional<Rank> launcher_rank() {
  std::optional<Rank> process = rank_of_process();
  std::optional<Rank> task = rank_of_array_task();
  if (task && (!process || process->size == 1)) return task;
  if (!task) return process;
  // Each task of the array starts several processes.
  return checked({task->rank * process->size + process->rank, task->size * process->size,
                  fmt::format("{} and {}", task->variable, process->variable)});
}

}  // namespace pillarfield::cli
