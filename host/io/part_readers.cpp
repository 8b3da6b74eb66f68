#include "io/part_readers.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <system_error>

#include "pillarfield/error.h"
#include "pillarfield/status.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostOpenParts = 8;

}  // namespace

PartReaders::PartReaders(std::filesystem::path folder, ForcePart joined, const ForceFileInfo& info,
                         ReadOptions options)
    : folder_(std::move(folder)),
      joined_(std::move(joined)),
      rows_(info.rows),
      cols_(info.cols),
      uncertainty_(info.uncertainty),
      options_(std::move(options)) {
  for (std::uint64_t index = 1; index <= joined_.count; ++index) {
    const FrameRange frames = frames_of(part(index));
    ends_.push_back(frames.end);
    std::error_code failed;
    is_lost_.push_back(!std::filesystem::is_regular_file(file(index), failed));
    if (is_lost_.back()) lost_.push_back({index, frames, file(index).string() + " is absent"});
  }
}

ForcePart PartReaders::part(std::uint64_t index) const {
  ForcePart part = joined_;
  part.index = index;
  return part;
}

std::filesystem::path PartReaders::file(std::uint64_t index) const {
  return folder_ / part_file({}, index).filename();
}

ForceFileReader PartReaders::open(std::uint64_t index) const {
  ForceFileReader reader(file(index), options_);
  const ForceFileInfo& info = reader.info();
  const bool fits = info.part == part(index) && info.rows == rows_ && info.cols == cols_ &&
                    info.uncertainty == uncertainty_ &&
                    reader.frames() == frames_of(part(index)).frames();
  if (fits) return reader;
  throw Error(file(index).string(), "is not the part that was joined",
              "join the parts again, or solve this one again");
}

std::vector<LostPart> PartReaders::examine(const StepProgress& progress) const {
  std::vector<LostPart> lost;
  for (std::uint64_t index = 1; index <= joined_.count; ++index) {
    if (progress) progress(index - 1, joined_.count);
    try {
      static_cast<void>(open(index));
    } catch (const Error& error) {
      lost.push_back({index, frames_of(part(index)), error.what()});
    }
  }
  return lost;
}

const ForceFileReader& PartReaders::reader(std::uint64_t index) {
  const auto found = std::ranges::find(open_, index, &decltype(open_)::value_type::first);
  if (found != open_.end()) return found->second;
  if (open_.size() == kMostOpenParts) open_.pop_front();
  return open_.emplace_back(index, open(index)).second;
}

void PartReaders::fill(ForceField& forces) const {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  forces = ForceField(rows_, cols_);
  for (auto* plane : {&forces.shear_x, &forces.shear_y, &forces.normal}) {
    std::ranges::fill(*plane, kNaN);
  }
  if (uncertainty_) {
    for (auto& plane : forces.uncertainty) plane.assign(forces.pillars(), kNaN);
  }
  std::ranges::fill(forces.status, status::kInconsistent);
}

void PartReaders::read(std::uint64_t frame, ForceField& forces) {
  const auto at = static_cast<std::size_t>(std::ranges::upper_bound(ends_, frame) - ends_.begin());
  if (is_lost_[at]) return fill(forces);
  static_cast<void>(reader(at + 1).read(frame - frames_of(part(at + 1)).first, forces));
}

}  // namespace pillarfield
