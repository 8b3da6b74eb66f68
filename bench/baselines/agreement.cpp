#include "bench/baselines/agreement.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "pillarfield/error.h"

namespace pillarfield::bench {
namespace {

struct Solved {
  float shear_x;
  float shear_y;
  float normal;
  std::uint8_t status;
};

Solved pillar(const ForceFieldView& field, std::size_t index) {
  return {field.shear_x[index], field.shear_y[index], field.normal[index], field.status[index]};
}

std::string text_of(const Solved& solved) {
  return fmt::format("({}, {}, {}) N, status {}", solved.shear_x, solved.shear_y, solved.normal,
                     solved.status);
}

template <class Agree>
void require_all(std::string_view baseline, const ForceFieldView& theirs,
                 const ForceFieldView& ours, Agree agree) {
  constexpr const char* kMend = "correct one of the two before timing them";
  if (theirs.rows != ours.rows || theirs.cols != ours.cols) {
    throw Error(baseline, "the result has another size than ours", kMend);
  }
  for (std::size_t i = 0; i < ours.normal.size(); ++i) {
    if (agree(pillar(theirs, i), pillar(ours, i))) continue;
    throw Error(baseline,
                fmt::format("pillar {} is {}, ours is {}", i, text_of(pillar(theirs, i)),
                            text_of(pillar(ours, i))),
                kMend);
  }
}

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

}  // namespace

void require_same_bits(std::string_view baseline, const ForceFieldView& theirs,
                       const ForceFieldView& ours) {
  require_all(baseline, theirs, ours, [](const Solved& a, const Solved& b) {
    return same_bits(a.shear_x, b.shear_x) && same_bits(a.shear_y, b.shear_y) &&
           same_bits(a.normal, b.normal) && a.status == b.status;
  });
}

void require_near(std::string_view baseline, const ForceFieldView& theirs,
                  const ForceFieldView& ours, float tolerance) {
  require_all(baseline, theirs, ours, [=](const Solved& a, const Solved& b) {
    const float most = tolerance * std::hypot(b.shear_x, b.shear_y, b.normal);
    return std::abs(a.shear_x - b.shear_x) <= most && std::abs(a.shear_y - b.shear_y) <= most &&
           std::abs(a.normal - b.normal) <= most && a.status == b.status;
  });
}

}  // namespace pillarfield::bench
