#pragma once

// Random plans that drop, delay, duplicate and damage packets, and what a receiver must make of
// them.

#include <map>
#include <optional>
#include <set>

#include "pillarfield/frame_stream.h"
#include "tests/streams/source/sent_frames.h"

namespace pillarfield::streams_test {

using Arrivals = std::multimap<double, SentPacket>;

/// Drops, damages, delays or duplicates a packet that is sent at `time`, in frame intervals, or
/// lets it pass.
inline void send(const SentPacket& packet, double time, std::mt19937& random, bool reorders,
                 Arrivals& arrivals) {
  const std::uint64_t fate = random() % 40;
  const double delay = reorders ? 0.1 * static_cast<double>(random() % 60) : 0;
  if (fate == 0) return;
  if (fate == 1) {
    arrivals.emplace(time, damaged(packet, random));
    return;
  }
  if (fate <= 3) time += delay;
  if (fate == 4) arrivals.emplace(time + delay, packet);
  arrivals.emplace(time, packet);
}

/// The packets of some frames in the order in which they arrive. The first and the last frame
/// arrive whole, so that begin and end are known.
inline std::vector<SentPacket> damage(const std::vector<std::vector<SentPacket>>& frames,
                                      std::mt19937& random, bool reorders) {
  Arrivals arrivals;
  for (std::size_t frame = 0; frame < frames.size(); ++frame) {
    const auto& packets = frames[frame];
    const bool safe = frame == 0 || frame + 1 == frames.size();
    if (!safe && random() % 20 == 0) continue;  // All of it is lost.
    for (std::size_t part = 0; part < packets.size(); ++part) {
      const double time = static_cast<double>(frame) +
                          static_cast<double>(part) / static_cast<double>(packets.size());
      if (safe) {
        arrivals.emplace(time, packets[part]);
      } else {
        send(packets[part], time, random, reorders, arrivals);
      }
    }
  }
  std::vector<SentPacket> arriving;
  for (const auto& [time, packet] : arrivals) arriving.push_back(packet);
  return arriving;
}

/// Outcome that arriving packets must have.
struct Expected {
  StreamHealth health;
  /// By sequence of the frames delivered: the packets that came in time.
  std::map<std::uint64_t, std::vector<SentPacket>> frames;
};

/// The counts by their definitions, with knowledge of all packets. A frame ends with the first
/// packet of the frame `window` later.
inline Expected expect(const std::vector<SentPacket>& arriving, std::uint64_t window) {
  Expected expected;
  StreamHealth& health = expected.health;
  std::map<std::uint64_t, std::size_t> ends;  // by sequence, index of the packet that ends it
  std::uint64_t highest = 0;
  for (std::size_t i = 0; i < arriving.size(); ++i) {
    if (!arriving[i].intact) continue;
    const std::uint64_t sequence = arriving[i].header.sequence;
    for (std::uint64_t each = 0; each + window <= sequence; ++each) ends.try_emplace(each, i);
    highest = std::max(highest, sequence);
  }
  std::set<std::pair<std::uint64_t, std::uint32_t>> came;
  std::uint64_t highest_so_far = 0;
  for (std::size_t i = 0; i < arriving.size(); ++i) {
    const SentPacket& packet = arriving[i];
    const std::uint64_t sequence = packet.header.sequence;
    if (!packet.intact) {
      ++health.invalid;
    } else if (!came.emplace(sequence, packet.header.part).second) {
      ++health.duplicates;
    } else if (const auto end = ends.find(sequence); end != ends.end() && i >= end->second) {
      ++health.late;
    } else {
      if (sequence < highest_so_far) ++health.reordered;
      expected.frames[sequence].push_back(packet);
    }
    if (packet.intact) highest_so_far = std::max(highest_so_far, sequence);
  }
  const std::uint64_t first = arriving.front().header.sequence;
  health.frames = expected.frames.size();
  health.lost = highest + 1 - first - health.frames;
  for (const auto& [sequence, packets] : expected.frames) {
    if (packets.size() < packets[0].header.parts) ++health.incomplete;
  }
  return expected;
}

}  // namespace pillarfield::streams_test
