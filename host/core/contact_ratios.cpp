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

}  // namespace

PF_WIDE void add_ratios(const ForceFieldView& forces, const ContactRun& run, std::int64_t peak,
                        FrictionHistogram& histogram) {
  const auto peak_quanta = static_cast<double>(peak);
  const std::int64_t least = std::max<std::int64_t>(peak / 4, 1);
  const std::size_t begin = std::size_t{run.row} * forces.cols;
  const ForceQuanta quanta(forces.normal.size());
  for (std::uint32_t first = run.first; first < run.end; first += kBlock) {
    const std::uint32_t pillars = std::min(kBlock, run.end - first);
    const std::size_t at = begin + first;
    if (!makes_blocks(forces, at, pillars)) {
      for (std::uint32_t col = first; col < first + pillars; ++col) {
        const PillarForce pillar = pillar_at(forces, quanta, run.row, col);
        if (pillar.normal < least || !is_known(pillar.status)) continue;
        const auto ratio =
            ratio_of(static_cast<double>(pillar.shear_x), static_cast<double>(pillar.shear_y),
                     static_cast<double>(pillar.normal), peak_quanta);
        histogram.add(ratio.shear_over_normal, static_cast<std::uint32_t>(ratio.weight),
                      ratio.ceiling);
      }
      continue;
    }
    const std::int32_t* const mask = kMasks<std::int32_t>.data() + kBlock - pillars;
    const BlockQuanta normal = quantised(forces.normal.data() + at, mask);
    const BlockRatios ratios =
        ratios_of(quantised(forces.shear_x.data() + at, mask),
                  quantised(forces.shear_y.data() + at, mask), normal, peak_quanta);
    for (std::size_t i = 0; i < pillars; ++i) {
      if (normal[i] < least || !is_known(forces.status[at + i])) continue;
      histogram.add(ratios.shear_over_normal[i], static_cast<std::uint32_t>(ratios.weight[i]),
                    ratios.ceiling[i]);
    }
  }
}

}  // namespace pillarfield
