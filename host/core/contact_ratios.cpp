#include "core/contact_ratios.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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
using BlockRatios = Ratio<std::array<double, kBlock>>;

/// Forces in quanta.
PF_INLINE Ratio<double> ratio_of(double x, double y, double normal, double peak) {
  const double shear = std::sqrt(x * x + y * y);
  // The largest ratio at which the pillar, sheared in its direction, would not be ambiguous:
  // 1 / min(|cos d|, |sin d|) with d from a diagonal.
  const double least = std::min(std::abs(x + y), std::abs(y - x));
  return {shear / normal, std::numbers::sqrt2 * shear / least,
          FrictionHistogram::kMostWeight * normal / peak};
}

PF_INLINE BlockRatios ratios_of(const BlockQuanta& shear_x, const BlockQuanta& shear_y,
                                const BlockQuanta& normal, double peak) {
  BlockRatios ratios;
  for (std::size_t i = 0; i < kBlock; ++i) {
    const Ratio<double> each = ratio_of(shear_x[i], shear_y[i], normal[i], peak);
    ratios.shear_over_normal[i] = each.shear_over_normal;
    ratios.ceiling[i] = each.ceiling;
    ratios.weight[i] = each.weight;
  }
  return ratios;
}

/// Which pillars are asked, and what their weight is measured by, quanta.
struct Demand {
  std::int64_t least;
  double peak;
};

PF_INLINE void add_block(const ForceFieldView& forces, std::size_t at, std::uint32_t pillars,
                         const Demand& demand, FrictionHistogram& histogram) {
  const std::int32_t* const mask = kMasks<std::int32_t>.data() + kBlock - pillars;
  const BlockQuanta normal = quantised(forces.normal.data() + at, mask);
  const BlockRatios ratios =
      ratios_of(quantised(forces.shear_x.data() + at, mask),
                quantised(forces.shear_y.data() + at, mask), normal, demand.peak);
  for (std::size_t i = 0; i < pillars; ++i) {
    if (normal[i] < demand.least || !is_known(forces.status[at + i])) continue;
    histogram.add(ratios.shear_over_normal[i], static_cast<std::uint32_t>(ratios.weight[i]),
                  ratios.ceiling[i]);
  }
}

void add_pillar(const PillarForce& pillar, const Demand& demand, FrictionHistogram& histogram) {
  if (pillar.normal < demand.least || !is_known(pillar.status)) return;
  const auto ratio =
      ratio_of(static_cast<double>(pillar.shear_x), static_cast<double>(pillar.shear_y),
               static_cast<double>(pillar.normal), demand.peak);
  histogram.add(ratio.shear_over_normal, static_cast<std::uint32_t>(ratio.weight), ratio.ceiling);
}

}  // namespace

PF_WIDE void add_ratios(const ForceFieldView& forces, std::span<const ContactRun> runs,
                        float peak_n, FrictionHistogram& histogram) {
  const ForceQuanta quanta(forces.normal.size());
  const std::int64_t peak = quanta.of(peak_n);
  if (peak <= 0) return;
  const Demand demand = {std::max<std::int64_t>(peak / 4, 1), static_cast<double>(peak)};
  for (const ContactRun& run : runs) {
    for (std::uint32_t first = run.first; first < run.end; first += kBlock) {
      const std::uint32_t pillars = std::min(kBlock, run.end - first);
      const std::size_t at = std::size_t{run.row} * forces.cols + first;
      if (makes_blocks(forces, at, pillars)) {
        add_block(forces, at, pillars, demand, histogram);
        continue;
      }
      for (std::uint32_t col = first; col < first + pillars; ++col) {
        add_pillar(pillar_at(forces, quanta, run.row, col), demand, histogram);
      }
    }
  }
}

}  // namespace pillarfield
