#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "testbed/testbed.h"

namespace pillarfield::testbed {

/// Statistics of an angle over the forces of one site, as in Table II, rad.
struct Statistics {
  double mean;
  double deviation;   ///< sample standard deviation, over n - 1
  double mean_error;  ///< mean of |angle - ground truth|
};

/// Unwraps the angles about the truth. NaN for fewer than two.
[[nodiscard]] Statistics statistics_of(std::span<const double> angles_rad, double truth_rad);

/// Statistics of an estimator in a row of Table II, without forces that no sensel detects.
struct RowEstimate {
  Statistics run;       ///< of run 0; the paper has one run
  Statistics expected;  ///< mean over all runs
  Statistics spread;    ///< standard deviation over all runs
};

/// One row of Table II: an angle at a site.
struct Row {
  Site site;
  const char* angle;  ///< "phi" or "theta"
  double truth_rad;
  Statistics published;  ///< by the paper
  RowEstimate paper;
  RowEstimate direct;
};

/// Whether the published figures of a row are within two standard deviations over runs of the
/// expected ones of the paper's estimator.
struct Reproduced {
  bool mean;
  bool deviation;
  bool mean_error;
};
[[nodiscard]] Reproduced reproduced(const Row& row);

/// Formats a published figure with its printed digits: three after the point, or four.
[[nodiscard]] std::string as_printed(double figure);

/// Counts forces whose region differs from that of the ideal model for the true force.
struct Audit {
  std::uint64_t trials = 0;
  std::uint64_t wrong_regions = 0;
  std::uint64_t unflagged = 0;  ///< wrong regions that are neither ambiguous nor inconsistent
};

/// Table II, and the audit of the direct solve over all runs.
struct TableTwo {
  std::array<Row, 2 * kSites.size()> rows{};  ///< phi and theta, site by site
  Audit audit;
};

/// RMS of published minus expected value, rad, over the paper's 18 figures and its equations.
[[nodiscard]] double rms_difference(const TableTwo& table);

/// Computes Table II from `runs` >= 2 runs; about 15 µs each.
[[nodiscard]] TableTwo table_two(const Parameters& parameters, std::uint64_t runs);

/// Distance between the published and the expected figures of theta in region 1 for a dead zone.
struct ScanPoint {
  double dead_zone_n;   ///< in newtons: counts over counts per newton
  Statistics expected;  ///< of the paper's estimator, mean over runs
  double distance_rad;  ///< Euclidean distance of the three figures
};

/// Scans dead zones from 0 to 10 N in steps of 0.1 N, with the other `parameters`.
[[nodiscard]] std::vector<ScanPoint> scan_dead_zones(const Parameters& parameters,
                                                     std::uint64_t runs);

}  // namespace pillarfield::testbed
