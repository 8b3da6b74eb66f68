#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "testbed/testbed.h"

namespace pillarfield::testbed {

/// What Table II tells of an angle over the forces of one site, rad.
struct Statistics {
  double mean;
  double deviation;   ///< standard deviation of a sample, over n - 1
  double mean_error;  ///< mean of |angle - ground truth|
};

/// Of angles that are unwrapped about the truth first. Not numbers where there are fewer than two.
[[nodiscard]] Statistics statistics_of(std::span<const double> angles_rad, double truth_rad);

/// One estimator's answer to a row of Table II. Forces without contact have no angle and are left
/// out.
struct Answer {
  Statistics run;       ///< of run 0, as the paper has one
  Statistics expected;  ///< mean over all runs
  Statistics spread;    ///< standard deviation over all runs
};

/// One row of Table II: an angle at a site.
struct Row {
  Site site;
  const char* angle;  ///< "phi" or "theta"
  double truth_rad;
  Statistics published;  ///< by the paper
  Answer paper;
  Answer direct;
};

/// Which of the paper's figures of a row its estimator has here: those within two standard
/// deviations over runs of what is expected.
struct Reproduced {
  bool mean;
  bool deviation;
  bool mean_error;
};
[[nodiscard]] Reproduced reproduced(const Row& row);

/// A published figure with the digits it has in print: three behind the point, or four.
[[nodiscard]] std::string as_printed(double figure);

/// How often the usable sensels tell another region than the ideal model does for the true force,
/// and whether the status byte warns of it.
struct Audit {
  std::uint64_t trials = 0;
  std::uint64_t wrong_regions = 0;
  std::uint64_t unflagged = 0;  ///< of the wrong ones: neither ambiguous nor inconsistent
};

/// Table II, and the audit of the direct solve over the trials of all runs.
struct TableTwo {
  std::array<Row, 2 * kSites.size()> rows{};  ///< phi and theta, site by site
  Audit audit;
};

/// Root mean square, over the paper's 18 figures, of the difference between what it prints and what
/// is expected of its equations here, rad.
[[nodiscard]] double rms_difference(const TableTwo& table);

/// Makes Table II from `runs` runs, at least 2; some 15 µs each.
[[nodiscard]] TableTwo table_two(const Parameters& parameters, std::uint64_t runs);

/// How near a dead zone comes to what the paper prints of theta in region 1.
struct ScanPoint {
  double dead_zone_n;   ///< in newtons: counts over counts per newton
  Statistics expected;  ///< of the paper's estimator, mean over runs
  double distance_rad;  ///< root of the summed squares of the differences in the three figures
};

/// Tries dead zones from 0 to 10 N in steps of 0.1 N, all else being as in `parameters`.
[[nodiscard]] std::vector<ScanPoint> scan_dead_zones(const Parameters& parameters,
                                                     std::uint64_t runs);

}  // namespace pillarfield::testbed
