#include "pillarfield/whole_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "base/thread_pool.h"
#include "pillarfield/error.h"
#include "pipeline/body/patch_load.h"
#include "pipeline/body/patch_memory.h"
#include "pipeline/body/patch_stack.h"
#include "skin/vectors.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

bool is_finite(const Vector3& vector) {
  return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
}

bool is_right_handed(const Pose& pose) {
  constexpr double kTolerance = 1e-9;
  const Vector3 difference = cross(pose.tangent_x, pose.tangent_y) - pose.normal;
  return is_finite(pose.position_mm) && dot(difference, difference) < kTolerance &&
         std::abs(dot(pose.tangent_x, pose.tangent_x) - 1) < kTolerance &&
         std::abs(dot(pose.tangent_y, pose.tangent_y) - 1) < kTolerance &&
         std::abs(dot(pose.tangent_x, pose.tangent_y)) < kTolerance;
}

void check_skin(const BodySkin& skin) {
  if (skin.patches.empty() || skin.patches.size() > kMostPatches) {
    throw Error("body", fmt::format("has {} patches", skin.patches.size()),
                fmt::format("give 1 to {}", kMostPatches));
  }
  if (!(skin.refresh_s > 0 && skin.refresh_s <= 3600)) {
    throw Error("body", fmt::format("refresh_s is {:g}", skin.refresh_s),
                "give a time above 0, up to 3600 s");
  }
  for (const BodyPatch& patch : skin.patches) {
    if (is_right_handed(patch.pose)) continue;
    throw Error("patch " + patch.name, "its pose is not a rigid motion",
                "give perpendicular unit vectors with tangent_x x tangent_y = normal");
  }
}

}  // namespace

/// A patch: its readings, in the frame of its stack, and its load.
struct WholePatch {
  WholePatch(const BodyPatch& patch, double refresh_s, std::span<std::byte> readings)
      : memory(patch.plan.skin, patch.plan.sensel_type, refresh_s, readings),
        load(patch.plan.skin, neighbour_reach(patch.plan)) {}

  /// Passes the changes on.
  void mark(PatchStack& stack, std::size_t at) {
    const auto changed = memory.changed();
    stack.mark(at, changed);
    if (stack.solves_all()) {
      load.mark_all();
    } else {
      for (const SenselBlock& block : changed) load.mark(block);
    }
    memory.forget_changes();
  }

  PatchMemory memory;
  PatchLoad load;
  PatchState state;
};

struct WholeBody::State {
  BodySkin skin;
  std::vector<PatchStack> stacks;
  std::vector<WholePatch> patches;
  std::vector<PatchStack*> submitted;
  std::vector<std::size_t> solved;  ///< patches of these
  BodyLoad load;
  std::uint64_t invalid = 0;
  ThreadPool pool{std::max(std::thread::hardware_concurrency(), 1U)};

  [[nodiscard]] bool submit(PatchStack& stack) {
    bool received = false;
    for (std::size_t at = 0; at < stack.members().size(); ++at) {
      WholePatch& patch = patches[stack.members()[at]];
      received = received || patch.memory.received();
      patch.mark(stack, at);
    }
    return stack.submit(received);
  }
  void receive(PatchStack& stack) {
    stack.receive();
    for (std::size_t at = 0; at < stack.members().size(); ++at) {
      patches[stack.members()[at]].state.forces = stack.forces(at);
      solved.push_back(stack.members()[at]);
    }
  }
  void sum_loads() {
    pool.run(solved.size(), [this](std::size_t piece, std::size_t /*member*/) {
      WholePatch& patch = patches[solved[piece]];
      patch.state.load =
          load_of(patch.load.update(patch.state.forces), skin.patches[solved[piece]].pose);
    });
  }
};

WholeBody::WholeBody(const Device& device, BodySkin skin) : state_(std::make_unique<State>()) {
  check_skin(skin);
  state_->skin = std::move(skin);
  const std::vector<BodyPatch>& patches = state_->skin.patches;
  for (const BodyPatch& patch : patches) check(patch.plan, "patch " + patch.name);
  std::vector<std::span<std::byte>> readings(patches.size());
  for (std::vector<std::size_t>& members : PatchStack::divide(device, state_->skin)) {
    PatchStack& stack = state_->stacks.emplace_back(device, state_->skin, std::move(members));
    for (std::size_t at = 0; at < stack.members().size(); ++at) {
      readings[stack.members()[at]] = stack.readings(at);
    }
  }
  for (std::size_t i = 0; i < patches.size(); ++i) {
    state_->patches.emplace_back(patches[i], state_->skin.refresh_s, readings[i]);
  }
  state_->submitted.reserve(state_->stacks.size());
}

WholeBody::~WholeBody() = default;
WholeBody::WholeBody(WholeBody&&) noexcept = default;
WholeBody& WholeBody::operator=(WholeBody&&) noexcept = default;

bool WholeBody::receive(const PillarfieldPacket& header, std::span<const std::byte> readings,
                        std::chrono::nanoseconds arrived) {
  const Packet packet = {header, readings, arrived};  // Its checksum holds the patch.
  PillarfieldPacket alone = header;
  alone.patch = 0;  // A stream of its own.
  const bool is_known = header.patch < state_->patches.size();
  PatchMemory* const memory = is_known ? &state_->patches[header.patch].memory : nullptr;
  if (!is_known || shape_of(alone) != memory->shape() || !is_intact(packet, memory->shape())) {
    ++state_->invalid;
    return false;
  }
  memory->add(packet);
  return true;
}

void WholeBody::solve() {
  State& body = *state_;
  body.submitted.clear();
  for (PatchStack& stack : body.stacks) {
    if (body.submit(stack)) body.submitted.push_back(&stack);
  }
  body.solved.clear();
  for (PatchStack* const stack : body.submitted) body.receive(*stack);
  body.sum_loads();
  body.load = {};
  for (WholePatch& patch : body.patches) {
    patch.memory.describe(patch.state);
    add(body.load, patch.state.load);
  }
}

const BodySkin& WholeBody::skin() const { return state_->skin; }
const PatchState& WholeBody::patch(std::size_t index) const {
  return state_->patches.at(index).state;
}
const BodyLoad& WholeBody::load() const { return state_->load; }
FrameView WholeBody::readings(std::size_t index) const {
  return state_->patches.at(index).memory.readings();
}
std::uint64_t WholeBody::invalid() const { return state_->invalid; }

}  // namespace pillarfield
