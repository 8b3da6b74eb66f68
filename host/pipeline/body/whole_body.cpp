#include "pillarfield/whole_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pillarfield/error.h"
#include "pipeline/body/patch_load.h"
#include "pipeline/body/patch_memory.h"
#include "skin/vectors.h"
#include "solve/stages.h"

namespace pillarfield {
namespace {

constexpr std::size_t kMostPatches = 1024;

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
    throw Error("patch " + patch.name, "its pose is no rotation and place",
                "give perpendicular unit vectors with tangent_x x tangent_y = normal");
  }
}

}  // namespace

/// A patch with its own kernel arguments, memory and results.
struct WholePatch {
  WholePatch(const Device& device, const BodyPatch& patch, double refresh_s)
      : memory(patch.plan.skin, patch.plan.sensel_type, refresh_s),
        processor(device, patch.plan, {.frames_in_flight = 1, .changes = true}),
        load(patch.plan.skin, neighbour_reach(patch.plan)),
        solves_all(!may_solve_changes(patch.plan)) {}

  /// Starts the solve, if there is anything to solve.
  bool submit() {
    const auto changed = memory.changed();
    if (solved && changed.empty() && !solves_all) return false;
    if (!solved || solves_all) {
      processor.submit(memory.readings());
      load.mark_all();
    } else {
      processor.submit(memory.readings(), changed);
      for (const SenselBlock& block : changed) load.mark(block);
    }
    memory.forget_changes();
    solved = true;
    return true;
  }

  void receive(const Pose& pose) {
    state.forces = processor.receive();
    state.load = load_of(load.update(state.forces), pose);
  }

  PatchMemory memory;
  Processor processor;
  PatchLoad load;
  PatchState state;
  bool solves_all;  ///< its plan needs all readings of each frame
  bool solved = false;
};

struct WholeBody::State {
  BodySkin skin;
  std::vector<WholePatch> patches;
  std::vector<std::size_t> submitted;
  BodyLoad load;
  std::uint64_t invalid = 0;
};

WholeBody::WholeBody(const Device& device, BodySkin skin) : state_(std::make_unique<State>()) {
  check_skin(skin);
  state_->skin = std::move(skin);
  for (const BodyPatch& patch : state_->skin.patches) {
    check(patch.plan, "patch " + patch.name);
    state_->patches.emplace_back(device, patch, state_->skin.refresh_s);
  }
  state_->submitted.reserve(state_->patches.size());
}

WholeBody::~WholeBody() = default;
WholeBody::WholeBody(WholeBody&&) noexcept = default;
WholeBody& WholeBody::operator=(WholeBody&&) noexcept = default;

bool WholeBody::receive(const PillarfieldPacket& header, std::span<const std::byte> readings,
                        std::chrono::nanoseconds arrived) {
  Packet packet = {header, readings, arrived};
  packet.header.patch = 0;  // A stream of its own from here on.
  const bool is_known = header.patch < state_->patches.size();
  PatchMemory* const memory = is_known ? &state_->patches[header.patch].memory : nullptr;
  if (!is_known || shape_of(packet.header) != memory->shape() ||
      !is_intact(packet, memory->shape())) {
    ++state_->invalid;
    return false;
  }
  memory->add(packet);
  return true;
}

void WholeBody::solve() {
  State& body = *state_;
  body.submitted.clear();
  for (std::size_t i = 0; i < body.patches.size(); ++i) {
    if (body.patches[i].submit()) body.submitted.push_back(i);
  }
  for (const std::size_t i : body.submitted) body.patches[i].receive(body.skin.patches[i].pose);
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
