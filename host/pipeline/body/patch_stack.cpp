#include "pipeline/body/patch_stack.h"

#include <algorithm>
#include <map>
#include <string>

#include "pillarfield/tuning.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

constexpr std::uint32_t kGapRows = 2 * kMostReach;  ///< sensels

/// Appends the plane of a patch, and before it that of the gap.
template <class Value>
void append(std::vector<Value>& plane, const std::vector<Value>& patch, std::size_t gap,
            Value neutral) {
  if (patch.empty()) return;
  plane.insert(plane.end(), gap, neutral);
  plane.insert(plane.end(), patch.begin(), patch.end());
}

/// The plan of several patches that have one program.
SolverPlan stacked_plan(const BodySkin& skin, const std::vector<std::size_t>& members) {
  SolverPlan stack = skin.patches[members.front()].plan;
  if (members.size() == 1) return stack;
  stack.skin.surface.reset();
  for (auto member = members.begin() + 1; member != members.end(); ++member) {
    const SolverPlan& plan = skin.patches[*member].plan;
    const std::size_t gap = std::size_t{kGapRows} * stack.skin.cols;
    append(stack.calibration.tare, plan.calibration.tare, gap, 0.0F);
    append(stack.calibration.gain, plan.calibration.gain, gap, 1.0F);
    append(stack.calibration.dead_zone, plan.calibration.dead_zone, gap, 0.0F);
    append(stack.calibration.mask, plan.calibration.mask, gap, kGood);
    stack.skin.rows += kGapRows + plan.skin.rows;
  }
  return stack;
}

bool may_be_stacked(const SolverPlan& plan) {
  return may_solve_changes(plan) && plan.calibration.noise.empty() && plan.skin.rows % 2 == 0;
}

}  // namespace

std::vector<std::vector<std::size_t>> PatchStack::divide(const Device& device,
                                                         const BodySkin& skin) {
  const auto program = [&](const SolverPlan& plan) {
    return kernel_source(plan, device.info().lanes, {.changed_only = true});
  };
  std::vector<std::vector<std::size_t>> stacks;
  std::map<std::pair<std::uint32_t, std::string>, std::size_t> open;
  for (std::size_t i = 0; i < skin.patches.size(); ++i) {
    const SolverPlan& plan = skin.patches[i].plan;
    if (!may_be_stacked(plan)) {
      stacks.push_back({i});
      continue;
    }
    const auto [found, is_new] = open.try_emplace({plan.skin.cols, program(plan)}, stacks.size());
    if (!is_new) {
      std::vector<std::size_t>& members = stacks[found->second];
      members.push_back(i);
      const SolverPlan all = stacked_plan(skin, members);
      if (all.skin.rows <= kMaxSensels && program(all) == found->first.second) continue;
      members.pop_back();
      found->second = stacks.size();
    }
    stacks.push_back({i});
  }
  return stacks;
}

PatchStack::PatchStack(const Device& device, const BodySkin& skin, std::vector<std::size_t> members)
    : members_(std::move(members)),
      solves_all_(!may_solve_changes(skin.patches[members_.front()].plan)),
      frame_(SenselType::u8, 2, 2),
      processor_([&] {
        const SolverPlan plan = stacked_plan(skin, members_);
        row_bytes_ = plan.skin.cols * size_of(plan.sensel_type);
        frame_ = FrameBuffer(plan.sensel_type, plan.skin.rows, plan.skin.cols);
        return Processor(device, plan, {.frames_in_flight = 1, .changes = true});
      }()) {
  std::uint32_t row = 0;
  for (const std::size_t member : members_) {
    const std::uint32_t rows = skin.patches[member].plan.skin.rows;
    places_.push_back({row, rows});
    row += rows + kGapRows;
  }
}

std::span<std::byte> PatchStack::readings(std::size_t at) {
  return frame_.bytes().subspan(places_[at].first_row * row_bytes_, places_[at].rows * row_bytes_);
}

void PatchStack::mark(std::size_t at, std::span<const SenselBlock> changed) {
  for (SenselBlock block : changed) {
    block.first_row += places_[at].first_row;
    changed_.push_back(block);
  }
}

bool PatchStack::submit(bool received) {
  if (solves_all()) {
    if (solved_ && !received) return false;
    processor_.submit(frame_.view());
  } else if (changed_.empty()) {
    return false;
  } else {
    processor_.submit(frame_.view(), changed_);
  }
  changed_.clear();
  solved_ = true;
  return true;
}

ForceFieldView PatchStack::forces(std::size_t at) const {
  ForceFieldView view = forces_;
  view.rows = places_[at].rows / 2;
  const std::size_t first = std::size_t{places_[at].first_row / 2} * view.cols;
  const std::size_t pillars = std::size_t{view.rows} * view.cols;
  const auto narrow = [&](auto& plane) {
    if (!plane.empty()) plane = plane.subspan(first, pillars);
  };
  narrow(view.shear_x);
  narrow(view.shear_y);
  narrow(view.normal);
  narrow(view.status);
  narrow(view.magnitude);
  narrow(view.theta);
  narrow(view.phi);
  for (auto& plane : view.uncertainty) narrow(plane);
  return view;
}

}  // namespace pillarfield
