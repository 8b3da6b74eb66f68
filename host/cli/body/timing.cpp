#include "cli/body/timing.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "cli/body/packet_store.h"
#include "cli/progress.h"
#include "pipeline/body/block_sender.h"

namespace pillarfield::cli {
namespace {

using TimingClock = std::chrono::steady_clock;

constexpr int kTimedFrames = 31;
constexpr std::uint64_t kNeverRefreshed = std::numeric_limits<std::uint32_t>::max();

template <class Work>
double milliseconds_of(const Work& work) {
  const auto begin = TimingClock::now();
  work();
  return std::chrono::duration<double, std::milli>(TimingClock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// Idle but for a rectangle in the middle whose readings are 20 to 83 counts above the tare.
FrameBuffer frame_in_contact(const SolverPlan& plan, double share, std::uint32_t seed) {
  const Skin& skin = plan.skin;
  FrameBuffer frame(plan.sensel_type, skin.rows, skin.cols);
  std::minstd_rand random(seed);
  // Whole blocks, so that the share is that of the blocks.
  const auto sensels = [&](std::uint32_t all) {
    return std::min(all, 8 * static_cast<std::uint32_t>(std::lround(std::sqrt(share) * all / 8)));
  };
  const std::uint32_t rows = sensels(skin.rows);
  const std::uint32_t cols = sensels(skin.cols);
  const std::uint32_t first_row = (skin.rows - rows) / 16 * 8;
  const std::uint32_t first_col = (skin.cols - cols) / 16 * 8;
  const std::vector<float>& tare = plan.calibration.tare;
  for (std::uint32_t row = first_row; row < first_row + rows; ++row) {
    for (std::uint32_t col = first_col; col < first_col + cols; ++col) {
      const std::size_t at = std::size_t{row} * skin.cols + col;
      const auto above = static_cast<double>(20 + (random() >> 8) % 64);
      const double reading = (tare.empty() ? 0.0 : double{tare[at]}) + above;
      switch (plan.sensel_type) {
        case SenselType::u8:
          frame.readings<std::uint8_t>()[at] =
              static_cast<std::uint8_t>(std::clamp(reading, 0.0, 255.0));
          break;
        case SenselType::u16:
          frame.readings<std::uint16_t>()[at] = static_cast<std::uint16_t>(std::max(reading, 0.0));
          break;
        case SenselType::f32:
          frame.readings<float>()[at] = static_cast<float>(reading);
      }
    }
  }
  return frame;
}

/// Receives packets of changed blocks.
class ChangedReceiver {
 public:
  ChangedReceiver(const Device& device, const BodySkin& skin) : body_(device, skin) {}

  /// Makes the packets of two frames that follow each other in turn.
  void prepare(double share) {
    const auto& patches = body_.skin().patches;
    for (PacketStore& store : stores_) store.clear();
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
      BlockSender sender(patches[i].plan, i, kNeverRefreshed);
      const std::array<FrameBuffer, 2> frames = {frame_in_contact(patches[i].plan, share, 1),
                                                 frame_in_contact(patches[i].plan, share, 2)};
      // The first round is sent to an idle skin.
      for (std::size_t turn = 0; turn < 4; ++turn) {
        sender.send(frames[turn % 2], 1, 0,
                    [&](const PillarfieldPacket& header, std::span<const std::byte> readings) {
                      if (turn >= 2) stores_[turn % 2].add(header, readings, false);
                    });
      }
    }
    for (int i = 0; i < 2; ++i) receive();
  }

  void receive() {
    ++sequence_;
    const PacketStore& store = stores_[sequence_ % 2];
    for (const PacketStore::Entry& packet : store.packets()) {
      PillarfieldPacket header = packet.header;
      header.sequence = sequence_;
      body_.receive(header, store.readings(packet), {});
    }
    body_.solve();
  }

  [[nodiscard]] std::size_t bytes() const { return stores_[0].bytes(); }

 private:
  WholeBody body_;
  std::array<PacketStore, 2> stores_;
  std::uint64_t sequence_ = 0;
};

/// Copies and solves whole frames, as for a skin of one patch.
class WholeReceiver {
 public:
  WholeReceiver(const Device& device, const BodySkin& skin) : skin_(skin) {
    for (const BodyPatch& patch : skin.patches) {
      const Skin& size = patch.plan.skin;
      processors_.emplace_back(device, patch.plan, Processor::Options{.frames_in_flight = 1});
      received_.emplace_back(patch.plan.sensel_type, size.rows, size.cols);
    }
  }

  void prepare(double share) {
    for (std::uint32_t turn = 0; turn < 2; ++turn) {
      frames_[turn].clear();
      for (const BodyPatch& patch : skin_.patches) {
        frames_[turn].push_back(frame_in_contact(patch.plan, share, turn + 1));
      }
    }
    for (int i = 0; i < 2; ++i) receive();
  }

  void receive() {
    const std::vector<FrameBuffer>& frames = frames_[turn_++ % 2];
    for (std::size_t i = 0; i < frames.size(); ++i) {
      std::ranges::copy(frames[i].bytes(), received_[i].bytes().begin());
      processors_[i].submit(received_[i].view());
    }
    for (Processor& processor : processors_) static_cast<void>(processor.receive());
  }

  [[nodiscard]] std::size_t bytes() const {
    std::size_t bytes = 0;
    for (const FrameBuffer& frame : received_) {
      bytes += frame.bytes().size() + sizeof(PillarfieldPacket);
    }
    return bytes;
  }

 private:
  const BodySkin& skin_;
  std::vector<Processor> processors_;
  std::vector<FrameBuffer> received_;
  std::array<std::vector<FrameBuffer>, 2> frames_;
  std::size_t turn_ = 0;
};

}  // namespace

std::vector<BodyTiming> time_body(const Device& device, const BodySkin& skin,
                                  const std::vector<double>& shares, bool quiet) {
  ChangedReceiver changed(device, skin);
  WholeReceiver whole(device, skin);
  std::vector<BodyTiming> timings;
  Progress progress("Timing", shares.size(), quiet);
  for (const double share : shares) {
    changed.prepare(share);
    whole.prepare(share);
    std::vector<double> changed_ms;
    std::vector<double> whole_ms;
    for (int i = 0; i < kTimedFrames; ++i) {
      changed_ms.push_back(milliseconds_of([&] { changed.receive(); }));
      whole_ms.push_back(milliseconds_of([&] { whole.receive(); }));
    }
    timings.push_back(
        {share, median(changed_ms), median(whole_ms), changed.bytes(), whole.bytes()});
    progress.show(timings.size());
  }
  return timings;
}

double break_even(const std::vector<BodyTiming>& timings) {
  double below = 0;
  double gain_below = 0;
  for (const BodyTiming& timing : timings) {
    const double gain = timing.whole_ms - timing.changed_ms;
    if (gain <= 0) {
      return below == 0 ? 0 : below + (timing.share - below) * gain_below / (gain_below - gain);
    }
    below = timing.share;
    gain_below = gain;
  }
  return 1;
}

}  // namespace pillarfield::cli
