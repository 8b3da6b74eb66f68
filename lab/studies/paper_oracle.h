#pragma once

#include <cstddef>
#include <vector>

#include "lab/studies/oracle.h"

/// The paper's equations (2), (5), (7) and (8), errata mended, in 113 bits: ratios of readings,
/// tangents and angles as they are printed, and none of the code of kernels/pillar.
namespace pillarfield::oracle {

/// Choices that the equations leave in regions 1 and 2: the sensels i, j of (5), and the one whose
/// reading gives the magnitude by (2).
struct PaperChoice {
  std::size_t i = 0;
  std::size_t j = 2;
  std::size_t magnitude_from = 0;
};

/// The choices of docs/derivations/paper_solve.md for usable readings: P1, P2, and the largest
/// reading. More than one where they are a tie.
[[nodiscard]] std::vector<PaperChoice> paper_choices(const SomeReadings& usable);

/// The paper's force for one to four usable readings: in regions 1 and 2 with a choice, in region 3
/// half way in theta along the contour of (5), in region 4 along the skin. Two opposite readings
/// are no region of the paper; they get direct_force. Not a number where an equation is 0/0.
[[nodiscard]] Force paper_force(const SomeReadings& usable, Exact k, const PaperChoice& choice);

}  // namespace pillarfield::oracle
