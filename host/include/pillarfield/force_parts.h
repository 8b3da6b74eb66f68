#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "pillarfield/output_file.h"
#include "pillarfield/read_options.h"

namespace pillarfield {

/// Consecutive frames, from `first` to before `end`.
struct FrameRange {
  std::uint64_t first = 0;
  std::uint64_t end = 0;

  [[nodiscard]] std::uint64_t frames() const { return end - first; }
  bool operator==(const FrameRange&) const = default;
};

/// Frames at which a solve with a memory begins anew, so that ranges of frames can be solved apart
/// (docs/many_machines.md): 0, `every`, 2 `every`, ...
struct Checkpoints {
  std::uint64_t every = 0;    ///< frames from one to the next; 0: none
  std::uint64_t warm_up = 0;  ///< frames before each that are solved first, and not written
  bool operator==(const Checkpoints&) const = default;
};

/// One of `count` ranges of the frames of a source, which is solved into a file of its own.
struct ForcePart {
  std::uint64_t index = 1;   ///< 1 to `count`
  std::uint64_t count = 1;   ///< at most kMostParts
  std::uint64_t frames = 0;  ///< of the source
  Checkpoints checkpoints;
  std::string fingerprint;  ///< of source, plan and calibration
  bool operator==(const ForcePart&) const = default;
};
inline constexpr std::uint64_t kMostParts = 99'999;

/// The largest useful number of parts: one per checkpoint, or per frame without checkpoints.
[[nodiscard]] std::uint64_t most_parts(std::uint64_t frames, const Checkpoints& checkpoints);

/// Throws Error, naming `where`, unless index and count are in range and every part has a frame.
void check(const ForcePart& part, const std::string& where);

/// The frames of a part: ranges of equal size, as far as they begin at checkpoints.
[[nodiscard]] FrameRange frames_of(const ForcePart& part);

/// The file of part `index` of an output: out.h5.parts/00007.h5.
[[nodiscard]] std::filesystem::path part_file(const std::filesystem::path& output,
                                              std::uint64_t index);

/// Whether the file exists and is this part, complete: what a restart need not solve again.
[[nodiscard]] bool holds_part(const std::filesystem::path& file, const ForcePart& part);

/// Throws Error if `file` holds a part of the same solve in another number of parts, or with other
/// checkpoints: array jobs that repeat some tasks count them anew, and would replace good parts.
void require_same_division(const std::filesystem::path& file, const ForcePart& part);

/// Called often during a long work on parts, with the steps done so far and all of them; both may
/// stay as they were. What it throws ends the work.
using StepProgress = std::function<void(std::uint64_t done, std::uint64_t all)>;

struct JoinOptions {
  Replace replace = Replace::results;
  ReadOptions read;  ///< of the parts
  StepProgress progress = {};
};

/// Writes `output`, an HDF5 file of forces with the bits of the serial solve, from the parts in its
/// folder `output` + ".parts", which may be removed then. Returns what the parts say of all of
/// them.
///
/// Throws Error if a part is absent, damaged or incomplete, or if they differ in source, plan,
/// calibration or count.
ForcePart join_parts(const std::filesystem::path& output, const JoinOptions& options = {});

}  // namespace pillarfield
