#include "cli/body/simulation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include "cli/progress.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"
#include "pillarfield/simulator.h"

namespace pillarfield::cli {
namespace {

using BodyClock = std::chrono::steady_clock;
using Nanos = std::chrono::nanoseconds;

/// Frames whose packets are made at once.
constexpr std::uint64_t kBatch = 32;

double since_ms(BodyClock::time_point begin) {
  return std::chrono::duration<double, std::milli>(BodyClock::now() - begin).count();
}

void stop_if_interrupted_body() {
  if (is_interrupted()) throw Error("body", "interrupted", "start again");
}

}  // namespace

struct BodySimulation::Patch {
  Patch(const BodyPatch& skin, const BodyFile::Simulated& simulated, std::uint32_t number,
        std::uint64_t refresh_frames)
      : sender(skin.plan, number, refresh_frames),
        losses({skin.plan.sensel_type, skin.plan.skin.rows, skin.plan.skin.cols}),
        clock_offset_s(simulated.clock_offset_s),
        clock_rate(1 + 1e-6 * simulated.clock_drift_ppm) {}

  [[nodiscard]] std::uint64_t device_ns(double host_s) const {
    constexpr double kBegan = 1e7;  // Clocks are above zero, whatever their offset.
    return static_cast<std::uint64_t>(
        std::llround(1e9 * (kBegan + clock_offset_s + host_s * clock_rate)));
  }

  std::vector<FrameBuffer> frames;
  BlockSender sender;
  LossRecord losses;
  double clock_offset_s;
  double clock_rate;
};

BodySimulation::BodySimulation(const BodyFile& body, std::uint64_t most_frames, bool quiet)
    : body_(body) {
  const auto refresh =
      static_cast<std::uint64_t>(std::floor(body.skin.refresh_s * body.skin.rate_hz));
  Progress progress("Simulating", body.skin.patches.size(), quiet);
  for (std::size_t i = 0; i < body.skin.patches.size(); ++i) {
    const Scene& scene = body.simulated[i].scene;
    const Simulator simulator(scene);
    auto patch = std::make_unique<Patch>(body.skin.patches[i], body.simulated[i],
                                         static_cast<std::uint32_t>(i), refresh);
    ForceField truth(scene.skin.pillar_rows(), scene.skin.pillar_cols());
    const auto frames = std::min<std::uint64_t>(scene.frames, most_frames);
    for (std::uint64_t frame = 0; frame < frames; ++frame) {
      stop_if_interrupted_body();
      patch->frames.emplace_back(simulator.sensel_type(), scene.skin.rows, scene.skin.cols);
      simulator.render(frame, patch->frames.back(), truth);
    }
    patches_.push_back(std::move(patch));
    progress.show(i + 1);
  }
}

BodySimulation::~BodySimulation() = default;

const FrameBuffer& BodySimulation::frame(std::size_t patch, std::uint64_t index) const {
  const std::vector<FrameBuffer>& frames = patches_[patch]->frames;
  if (frames.size() == 1) return frames.front();
  const std::uint64_t turn = index % (2 * frames.size() - 2);
  return frames[turn < frames.size() ? turn : 2 * frames.size() - 2 - turn];
}

BodyRun BodySimulation::run(WholeBody& receiver, std::uint64_t frames, double loss,
                            std::uint64_t seed, bool quiet) {
  std::mt19937_64 random(seed);
  std::bernoulli_distribution is_lost(loss);
  std::exponential_distribution<double> delay_s(1 / 50e-6);
  const double period_s = 1 / body_.skin.rate_hz;
  const BodyClock::duration origin = BodyClock::now().time_since_epoch();
  std::vector<PacketStore> stores(kBatch);
  std::uint64_t blocks = 0;
  std::uint64_t changed = 0;
  std::uint64_t sent = 0;
  double free_s = 0;  // When the receiver is done with the frame before.
  BodyRun run;
  Progress progress("Running", frames, quiet);
  for (std::uint64_t first = 0; first < frames; first += kBatch) {
    const std::uint64_t end = std::min(first + kBatch, frames);
    for (std::uint64_t i = first; i < end; ++i) {
      PacketStore& store = stores[i - first];
      store.clear();
      for (std::size_t at = 0; at < patches_.size(); ++at) {
        Patch& patch = *patches_[at];
        const double host_s = static_cast<double>(i) * period_s;
        patch.sender.send(frame(at, i), i + 1, patch.device_ns(host_s),
                          [&](const PillarfieldPacket& header, std::span<const std::byte> bytes) {
                            store.add(header, bytes, i > 0 && is_lost(random));
                          });
        blocks +=
            FrameShape{body_.skin.patches[at].plan.sensel_type,
                       body_.skin.patches[at].plan.skin.rows, body_.skin.patches[at].plan.skin.cols}
                .blocks();
        changed += patch.sender.changed();
        sent += patch.sender.sent();
      }
      run.packets += store.packets().size();
      run.bytes += store.bytes();
    }
    for (std::uint64_t i = first; i < end; ++i) {
      stop_if_interrupted_body();
      const PacketStore& store = stores[i - first];
      for (const PacketStore::Entry& packet : store.packets()) {
        if (!packet.lost) continue;
        ++run.lost_packets;
        patches_[packet.header.patch]->losses.lose(store.readings(packet),
                                                   receiver.readings(packet.header.patch), i + 1);
      }
      const double scanned_s = static_cast<double>(i) * period_s;
      const Nanos arrived = origin + Nanos(std::llround(1e9 * (scanned_s + delay_s(random))));
      const auto begin = BodyClock::now();
      for (const PacketStore::Entry& packet : store.packets()) {
        if (!packet.lost) receiver.receive(packet.header, store.readings(packet), arrived);
      }
      const double receive_ms = since_ms(begin);
      receiver.solve();
      const double frame_ms = since_ms(begin);
      for (const PacketStore::Entry& packet : store.packets()) {
        if (packet.lost) continue;
        patches_[packet.header.patch]->losses.heal(store.readings(packet), i + 1);
      }
      if (i == 0) continue;  // All blocks of all patches.
      run.receive_ms.push_back(receive_ms);
      run.frame_ms.push_back(frame_ms);
      free_s = std::max(free_s, scanned_s) + 1e-3 * frame_ms;
      if (free_s > scanned_s + period_s) ++run.late;
      progress.show(i + 1);
    }
  }
  const Nanos scanned =
      origin + Nanos(std::llround(1e9 * static_cast<double>(frames - 1) * period_s));
  for (std::size_t at = 0; at < patches_.size(); ++at) {
    const LossRecord& losses = patches_[at]->losses;
    run.old_blocks += losses.lost();
    run.old_at_end += losses.old_now();
    run.longest_healing_s =
        std::max(run.longest_healing_s, static_cast<double>(losses.longest(frames)) * period_s);
    const PatchState& state = receiver.patch(at);
    if (state.sequence != frames) continue;  // Its last packets were lost.
    run.worst_clock_s =
        std::max(run.worst_clock_s,
                 std::abs(1e-9 * static_cast<double>((state.host_time - scanned).count())));
  }
  run.changed_share = static_cast<double>(changed) / static_cast<double>(blocks);
  run.sent_share = static_cast<double>(sent) / static_cast<double>(blocks);
  return run;
}

}  // namespace pillarfield::cli
