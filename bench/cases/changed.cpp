// Frames of which a part of the blocks changed, solved as changes and whole.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bench/cases/cases.h"
#include "bench/timing/solve_timing.h"

namespace pillarfield::bench {
namespace {

/// Two frames in turn that differ in a square of whole blocks; the skin is idle elsewhere.
class ChangingSquare {
 public:
  ChangingSquare(const SolverPlan& plan, double share) {
    const Skin& skin = plan.skin;
    const Frames loaded(skin, plan.sensel_type, {});
    const auto side = [share](std::uint32_t all) {
      return std::min(all, 8 * static_cast<std::uint32_t>(std::lround(std::sqrt(share) * all / 8)));
    };
    changed_ = {skin.rows / 32 * 8, side(skin.rows), skin.cols / 32 * 8, side(skin.cols)};
    changed_.first_row = std::min(changed_.first_row, skin.rows - changed_.rows);
    changed_.first_col = std::min(changed_.first_col, skin.cols - changed_.cols);
    for (std::size_t i = 0; i < 2; ++i) {
      frames_.emplace_back(plan.sensel_type, skin.rows, skin.cols);
      const auto* const from = static_cast<const std::byte*>(loaded[i].data);
      for (std::uint32_t row = 0; row < changed_.rows; ++row) {
        const std::size_t at =
            std::size_t{changed_.first_row + row} * skin.cols + changed_.first_col;
        const std::size_t size = size_of(plan.sensel_type);
        std::memcpy(&frames_[i].bytes()[at * size], from + at * size, changed_.cols * size);
      }
    }
  }

  [[nodiscard]] const SenselBlock& changed() const { return changed_; }
  FrameView next() { return frames_[turn_++ % 2].view(); }

 private:
  SenselBlock changed_;
  std::vector<FrameBuffer> frames_;
  std::size_t turn_ = 0;
};

Measurement time_changed(const Session& session, const SolverPlan& plan, double share) {
  ChangingSquare square(plan, share);
  Processor parts(session.device, plan, {.frames_in_flight = 1, .changes = true});
  Processor whole(session.device, plan, {.frames_in_flight = 1});
  InterleavedTiming timing;
  const std::size_t changes = timing.add([&](int frames) {
    for (int i = 0; i < frames; ++i) {
      parts.submit(square.next(), {&square.changed(), 1});
      static_cast<void>(parts.receive());
    }
  });
  const std::size_t all = timing.add([&](int frames) {
    for (int i = 0; i < frames; ++i) {
      whole.submit(square.next());
      static_cast<void>(whole.receive());
    }
  });
  timing.run(session.length);
  Measurement measured = measurement_of(timing, changes, plan);
  measured.counters["over_whole"] = timing.ratio(changes, all);
  return measured;
}

}  // namespace

void add_changed_cases(const Session& session) {
  for (const double percent : {1.0, 5.0, 20.0, 100.0}) {
    for (const char* const stage : {"none", "all"}) {
      const char* const what = stage == std::string_view("none") ? "bare" : "all";
      add_case(fmt::format("changed/{}/{}", percent, what), [&session, percent, stage] {
        SolverPlan plan = bare_plan(kSquareMetre);
        add_stage(plan, stage);
        return time_changed(session, plan, percent / 100);
      });
    }
  }
}

}  // namespace pillarfield::bench
