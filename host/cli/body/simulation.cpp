#include "cli/body/simulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>

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

/// Runs a simulation frame by frame.
class BodySimulation::Runner {
 public:
  Runner(BodySimulation& simulation, WholeBody& receiver, double loss, std::uint64_t seed)
      : simulation_(simulation),
        receiver_(receiver),
        period_s_(1 / simulation.body_.skin.rate_hz),
        random_(seed),
        is_lost_(loss) {}

  /// Makes the packets of some frames, then receives and solves them.
  void run_batch(std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t frame = first; frame < end; ++frame) send(frame, stores_[frame - first]);
    for (std::uint64_t frame = first; frame < end; ++frame) {
      stop_if_interrupted_body();
      receive(frame, stores_[frame - first]);
    }
  }

  [[nodiscard]] BodyRun finish(std::uint64_t frames);

 private:
  void send(std::uint64_t frame, PacketStore& store);
  void receive(std::uint64_t frame, const PacketStore& store);
  void count_losses(std::uint64_t frame, const PacketStore& store);
  void count_time(std::uint64_t frame, double receive_ms, double frame_ms);

  BodySimulation& simulation_;
  WholeBody& receiver_;
  double period_s_;
  std::mt19937_64 random_;
  std::bernoulli_distribution is_lost_;
  std::exponential_distribution<double> delay_s_{1 / 50e-6};
  Nanos origin_ = BodyClock::now().time_since_epoch();
  std::array<PacketStore, kBatch> stores_;
  std::uint64_t blocks_ = 0;
  std::uint64_t changed_ = 0;
  std::uint64_t sent_ = 0;
  double free_s_ = 0;  ///< when the receiver is done with the frame before
  BodyRun run_;
};

void BodySimulation::Runner::send(std::uint64_t frame, PacketStore& store) {
  store.clear();
  const double scanned_s = static_cast<double>(frame) * period_s_;
  for (std::size_t i = 0; i < simulation_.patches_.size(); ++i) {
    Patch& patch = *simulation_.patches_[i];
    patch.sender.send(simulation_.frame(i, frame), frame + 1, patch.device_ns(scanned_s),
                      [&](const PillarfieldPacket& header, std::span<const std::byte> readings) {
                        store.add(header, readings, frame > 0 && is_lost_(random_));
                      });
    blocks_ += patch.sender.blocks();
    changed_ += patch.sender.changed();
    sent_ += patch.sender.sent();
  }
  run_.packets += store.packets().size();
  run_.bytes += store.bytes();
}

void BodySimulation::Runner::receive(std::uint64_t frame, const PacketStore& store) {
  count_losses(frame, store);
  const Nanos arrived =
      origin_ +
      Nanos(std::llround(1e9 * (static_cast<double>(frame) * period_s_ + delay_s_(random_))));
  const auto begin = BodyClock::now();
  for (const PacketStore::Entry& packet : store.packets()) {
    if (!packet.lost) receiver_.receive(packet.header, store.readings(packet), arrived);
  }
  const double receive_ms = since_ms(begin);
  receiver_.solve();
  if (frame > 0) count_time(frame, receive_ms, since_ms(begin));  // The first sends all blocks.
  for (const PacketStore::Entry& packet : store.packets()) {
    if (packet.lost) continue;
    simulation_.patches_[packet.header.patch]->losses.heal(store.readings(packet), frame + 1);
  }
}

void BodySimulation::Runner::count_losses(std::uint64_t frame, const PacketStore& store) {
  for (const PacketStore::Entry& packet : store.packets()) {
    if (!packet.lost) continue;
    ++run_.lost_packets;
    const std::uint32_t patch = packet.header.patch;
    simulation_.patches_[patch]->losses.lose(store.readings(packet), receiver_.readings(patch),
                                             frame + 1);
  }
}

void BodySimulation::Runner::count_time(std::uint64_t frame, double receive_ms, double frame_ms) {
  const double scanned_s = static_cast<double>(frame) * period_s_;
  run_.receive_ms.push_back(receive_ms);
  run_.frame_ms.push_back(frame_ms);
  free_s_ = std::max(free_s_, scanned_s) + 1e-3 * frame_ms;
  if (free_s_ > scanned_s + period_s_) ++run_.late;
}

BodyRun BodySimulation::Runner::finish(std::uint64_t frames) {
  const Nanos scanned =
      origin_ + Nanos(std::llround(1e9 * static_cast<double>(frames - 1) * period_s_));
  for (std::size_t i = 0; i < simulation_.patches_.size(); ++i) {
    const LossRecord& losses = simulation_.patches_[i]->losses;
    run_.old_blocks += losses.lost();
    run_.old_at_end += losses.old_now();
    run_.longest_healing_s =
        std::max(run_.longest_healing_s, static_cast<double>(losses.longest(frames)) * period_s_);
    const PatchState& state = receiver_.patch(i);
    if (state.sequence != frames) continue;  // Its last packets were lost.
    const double error_s = 1e-9 * static_cast<double>((state.host_time - scanned).count());
    run_.worst_clock_s = std::max(run_.worst_clock_s, std::abs(error_s));
  }
  run_.changed_share = static_cast<double>(changed_) / static_cast<double>(blocks_);
  run_.sent_share = static_cast<double>(sent_) / static_cast<double>(blocks_);
  return std::move(run_);
}

BodyRun BodySimulation::run(WholeBody& receiver, std::uint64_t frames, double loss,
                            std::uint64_t seed, bool quiet) {
  Runner runner(*this, receiver, loss, seed);
  Progress progress("Running", frames, quiet);
  for (std::uint64_t first = 0; first < frames; first += kBatch) {
    const std::uint64_t end = std::min(first + kBatch, frames);
    runner.run_batch(first, end);
    progress.show(end);
  }
  return runner.finish(frames);
}

}  // namespace pillarfield::cli
