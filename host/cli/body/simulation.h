#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cli/body/loss_record.h"
#include "cli/body/packet_store.h"
#include "pillarfield/frame.h"
#include "pillarfield/whole_body.h"
#include "pipeline/body/block_sender.h"

namespace pillarfield::cli {

/// What a simulated run measured.
struct BodyRun {
  std::vector<double> receive_ms;  ///< of each frame
  std::vector<double> frame_ms;    ///< the same and the solve
  std::uint64_t late = 0;          ///< frames solved after the next one was due
  std::uint64_t packets = 0;
  std::uint64_t lost_packets = 0;
  std::uint64_t bytes = 0;
  double changed_share = 0;      ///< of the blocks of a frame, mean
  double sent_share = 0;         ///< the same with refreshed ones
  std::uint64_t old_blocks = 0;  ///< blocks whose change was lost
  std::uint64_t old_at_end = 0;  ///< of these, not sent again until the end
  double longest_healing_s = 0;
  double worst_clock_s = 0;  ///< largest error of a patch's host time in the last frame
};

/// The sensors of a body: frames of their scenes, forwards and backwards again and again, as
/// packets of changed blocks of which some are lost.
class BodySimulation {
 public:
  /// Renders at most `most_frames` frames of each scene.
  BodySimulation(const BodyFile& body, std::uint64_t most_frames, bool quiet);
  ~BodySimulation();

  /// Runs `frames` frames through `receiver`. Packets are made beforehand, so that only the
  /// receiver's work is timed.
  [[nodiscard]] BodyRun run(WholeBody& receiver, std::uint64_t frames, double loss,
                            std::uint64_t seed, bool quiet);

  /// The frame of a patch at a time.
  [[nodiscard]] const FrameBuffer& frame(std::size_t patch, std::uint64_t index) const;

 private:
  struct Patch;
  class Runner;
  const BodyFile& body_;
  std::vector<std::unique_ptr<Patch>> patches_;
};

}  // namespace pillarfield::cli
