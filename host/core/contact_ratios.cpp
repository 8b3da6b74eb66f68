#include "core/contact_ratios.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/contact_block.h"

namespace pillarfield {
namespace {

/// What a pillar, or each of a block, tells of friction.
template <class Number>
struct Ratio {
  Number shear_over_normal;
  Number ceiling;
  Number weight;
};
using BlockRatios = Ratio<std::array<float, kBlock>>;

/// Which pillars are asked, N, and how much of the greatest weight a newton has.
struct Demand {
  float least_n;
  float weight_per_n;
};

PF_INLINE Ratio<float> ratio_of(float x, float y, float normal, float weight_per_n) {
  const float shear = std::sqrt(x * x + y * y);
  // The largest ratio at which the pillar, sheared in its direction, would not be ambiguous:
  // 1 / min(|cos d|, |sin d|) with d from a diagonal.
  const float least = std::min(std::abs(x + y), std::abs(y - x));
  constexpr auto kMost = static_cast<float>(FrictionHistogram::kMostWeight);
  return {shear / normal, std::numbers::sqrt2_v<float> * shear / least,
          std::min(kMost, weight_per_n * normal)};
}

PF_INLINE BlockRatios ratios_of(const float* shear_x, const float* shear_y, const float* normal,
                                float weight_per_n) {
  BlockRatios ratios;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const Ratio<float> each = ratio_of(shear_x[i], shear_y[i], normal[i], weight_per_n);
    ratios.shear_over_normal[i] = each.shear_over_normal;
    ratios.ceiling[i] = each.ceiling;
    ratios.weight[i] = each.weight;
  }
  return ratios;
}

PF_INLINE bool is_asked(const ForceFieldView& forces, std::size_t at, const Demand& demand) {
  return forces.normal[at] >= demand.least_n && is_known(forces.status[at]);
}

/// The pillars of a block; of what is read past the last of them nothing is added.
PF_INLINE void add_block(const ForceFieldView& forces, std::size_t at, std::uint32_t pillars,
                         const Demand& demand, FrictionHistogram& histogram) {
  const BlockRatios ratios = ratios_of(forces.shear_x.data() + at, forces.shear_y.data() + at,
                                       forces.normal.data() + at, demand.weight_per_n);
  for (std::size_t i = 0; i < pillars; ++i) {
    if (!is_asked(forces, at + i, demand)) continue;
    histogram.add(ratios.shear_over_normal[i], static_cast<std::uint32_t>(ratios.weight[i]),
                  ratios.ceiling[i]);
  }
}

void add_pillar(const ForceFieldView& forces, std::size_t at, const Demand& demand,
                FrictionHistogram& histogram) {
  if (!is_asked(forces, at, demand)) return;
  const Ratio<float> ratio =
      ratio_of(forces.shear_x[at], forces.shear_y[at], forces.normal[at], demand.weight_per_n);
  histogram.add(ratio.shear_over_normal, static_cast<std::uint32_t>(ratio.weight), ratio.ceiling);
}

}  // namespace

PF_WIDE void add_ratios(const ForceFieldView& forces, std::span<const ContactRun> runs,
                        float peak_n, FrictionHistogram& histogram) {
  // Below the smallest normal number there is no weight per newton.
  if (!(peak_n >= std::numeric_limits<float>::min())) return;
  constexpr auto kMost = static_cast<float>(FrictionHistogram::kMostWeight);
  const Demand demand = {peak_n / 4, kMost / peak_n};
  for (std::size_t at_run = 0; at_run < runs.size(); ++at_run) {
    const ContactRun& run = runs[at_run];
    ask_for(forces.shear_x, forces, runs, at_run);
    ask_for(forces.shear_y, forces, runs, at_run);
    ask_for(forces.status, forces, runs, at_run);
    for (std::uint32_t first = run.first; first < run.end; first += kBlock) {
      const std::uint32_t pillars = std::min(kBlock, run.end - first);
      const std::size_t at = std::size_t{run.row} * forces.cols + first;
      if (at + kBlock <= forces.normal.size()) {
        add_block(forces, at, pillars, demand, histogram);
        continue;
      }
      for (std::size_t i = 0; i < pillars; ++i) add_pillar(forces, at + i, demand, histogram);
    }
  }
}

}  // namespace pillarfield
