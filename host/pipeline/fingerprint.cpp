#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <span>

#include "pillarfield/frame.h"
#include "pillarfield/solve_range.h"
#include "pillarfield/tuning.h"
#include "pillarfield/version.h"

namespace pillarfield {
namespace {

/// The hash FNV-1a of 64 bits, over words of 8 bytes.
class Hash {
 public:
  void add(std::uint64_t word) {
    value_ = (value_ ^ word) * 0x100000001b3;
    value_ ^= value_ >> 29;
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const std::optional<double>& number) {
    add(std::uint64_t{number.has_value()});
    add(number.value_or(0));
  }
  void add(std::span<const std::byte> bytes) {
    add(std::uint64_t{bytes.size()});
    while (!bytes.empty()) {
      std::uint64_t word = 0;
      const std::size_t size = std::min(bytes.size(), sizeof word);
      std::memcpy(&word, bytes.data(), size);
      add(word);
      bytes = bytes.subspan(size);
    }
  }
  template <class Value>
  void add_all(const std::vector<Value>& values) {
    add(std::as_bytes(std::span(values)));
  }
  void add(const std::string& text) { add(std::as_bytes(std::span(text))); }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

void add(Hash& hash, const FrictionKnowledge& friction) {
  hash.add(friction.median);
  hash.add(friction.spread);
  hash.add(friction.given);
  hash.add(friction.bound);
  hash.add(std::uint64_t{friction.memory});
}

/// The kernel names every constant and option of the plan; planes and the host's part follow.
void add(Hash& hash, const SolverPlan& plan) {
  hash.add(kernel_source(plan, 1));
  hash.add(std::string(name_of(plan.estimator)));
  hash.add(plan.segment_point);
  hash.add(plan.noise_counts);
  hash.add(plan.baseline_rate);
  hash.add(std::uint64_t(plan.baseline_interval));
  hash.add(plan.frame_interval_s);
  hash.add(std::uint64_t{plan.pressure});
  hash.add(plan.skin.sensel_pitch_mm.col_mm);
  if (!plan.skin.sensel_pitch_mm.is_square()) hash.add(plan.skin.sensel_pitch_mm.row_mm);
  hash.add(plan.skin.counts_per_newton);
  add(hash, plan.friction);
  const Calibration& planes = plan.calibration;
  for (const auto* plane : {&planes.tare, &planes.gain, &planes.dead_zone, &planes.noise,
                            &planes.bend_x, &planes.bend_y, &planes.bend_xy}) {
    hash.add_all(*plane);
  }
  hash.add_all(planes.mask);
  const std::optional<Surface>& surface = plan.skin.surface;
  hash.add(std::uint64_t{surface.has_value()});
  if (!surface) return;
  hash.add(std::uint64_t(surface->shape));
  hash.add(surface->radius_mm);
  hash.add(surface->axis_deg);
  hash.add_all(surface->heights_mm);
}

void add_frame(Hash& hash, FrameSource& source, std::uint64_t index) {
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  hash.add(source.read(index, frame));
  hash.add(std::as_bytes(frame.bytes()));
}

/// Adds evenly spaced frames, the first and the last among them: all would take as long as solving.
void add_frames(Hash& hash, FrameSource& source) {
  constexpr std::uint64_t kMostFrames = 32;
  const std::uint64_t last = source.frames() - std::min<std::uint64_t>(source.frames(), 1);
  const std::uint64_t frames = std::min(source.frames(), kMostFrames);
  for (std::uint64_t i = 0; i < frames; ++i) {
    add_frame(hash, source, i * last / std::max<std::uint64_t>(frames - 1, 1));
  }
}

}  // namespace

std::string fingerprint_of(FrameSource& source, const SolverPlan& plan,
                           const std::optional<ContactOptions>& contacts) {
  Hash hash;
  hash.add(std::string(kVersion));
  hash.add(source.frames());
  add_frames(hash, source);
  add(hash, plan);
  if (contacts) {
    hash.add(contacts->minimum_pillars);
    hash.add(contacts->reach_mm);
  }
  return fmt::format("{:016x}", hash.value());
}

}  // namespace pillarfield
