#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace pillarfield::cli {

/// The place of this process among those that a launcher started.
struct Rank {
  std::uint64_t rank = 0;  ///< 0 to size − 1
  std::uint64_t size = 1;
  std::string variable;  ///< of the environment, which gave the rank
};

/// The rank by the environment of mpirun (Open MPI, MPICH, Intel MPI), srun, or an array job of
/// Slurm or Grid Engine; nothing without one. Throws Error if its variables contradict each other.
[[nodiscard]] std::optional<Rank> launcher_rank();

}  // namespace pillarfield::cli
