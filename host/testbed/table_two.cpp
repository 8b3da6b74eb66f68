#include "testbed/table_two.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

#include "pillarfield/status.h"
#include "simulation/ideal_readings.h"

namespace pillarfield::testbed {
namespace {

constexpr std::size_t kRows = 2 * kSites.size();

/// The paper's figures in the order of TableTwo::rows.
constexpr std::array<Statistics, kRows> kPublished = {{
    {2.043, 0.093, 0.084},
    {0.551, 0.240, 0.177},
    {3.893, 0.152, 0.084},
    {0.926, 0.113, 0.0735},
    {5.890, 0.032, 0.130},
    {1.417, 0.013, 0.196},
}};
constexpr std::size_t kThetaInRegion1 = 1;

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// Mean and standard deviation by Welford's recurrence; ignores NaN.
class Moments {
 public:
  void add(double value) {
    if (std::isnan(value)) return;
    count_ += 1;
    const double change = value - mean_;
    mean_ += change / count_;
    squares_ += change * (value - mean_);
  }
  [[nodiscard]] double mean() const { return count_ < 1 ? kNotANumber : mean_; }
  [[nodiscard]] double deviation() const {
    return count_ < 2 ? kNotANumber : std::sqrt(squares_ / (count_ - 1));
  }

 private:
  double count_ = 0;
  double mean_ = 0;
  double squares_ = 0;
};

/// Accumulates the statistics of an estimator in a row over runs.
class RowStatistics {
 public:
  void add(const Statistics& run) {
    if (!first_) first_ = run;
    mean_.add(run.mean);
    deviation_.add(run.deviation);
    mean_error_.add(run.mean_error);
  }
  [[nodiscard]] RowEstimate all() const {
    return {first_.value(),
            {mean_.mean(), deviation_.mean(), mean_error_.mean()},
            {mean_.deviation(), deviation_.deviation(), mean_error_.deviation()}};
  }

 private:
  std::optional<Statistics> first_;
  Moments mean_;
  Moments deviation_;
  Moments mean_error_;
};

bool is_phi(std::size_t row) { return row % 2 == 0; }

double truth_of(std::size_t row) {
  const Site& site = kSites[row / 2];
  return is_phi(row) ? site.phi_rad : site.theta_rad;
}

/// Statistics of an estimator in a row of one run.
Statistics statistics_of_row(const Experiment& run, std::size_t row, Estimate Trial::*estimate) {
  std::vector<double> angles;
  for (const Trial& trial : run[row / 2]) {
    const Estimate& solved = trial.*estimate;
    if (region_of(static_cast<std::uint8_t>(solved.status)) == Region::none) continue;
    angles.push_back(is_phi(row) ? solved.direction.phi : solved.direction.theta);
  }
  return statistics_of(angles, truth_of(row));
}

void audit_run(const Experiment& run, double counts_per_newton, Audit& audit) {
  for (const Series& series : run) {
    for (const Trial& trial : series) {
      const auto status = static_cast<std::uint8_t>(trial.direct.status);
      const Region truth = region_of(usable_bits(ideal_readings(trial.truth, counts_per_newton)));
      const bool wrong = region_of(status) != truth;
      const bool flagged = (status & (status::kAmbiguous | status::kInconsistent)) != 0;
      audit.trials += 1;
      audit.wrong_regions += wrong ? 1 : 0;
      audit.unflagged += wrong && !flagged ? 1 : 0;
    }
  }
}

double distance(const Statistics& a, const Statistics& b) {
  return std::hypot(a.mean - b.mean, a.deviation - b.deviation, a.mean_error - b.mean_error);
}

}  // namespace

Statistics statistics_of(std::span<const double> angles_rad, double truth_rad) {
  if (angles_rad.size() < 2) return {kNotANumber, kNotANumber, kNotANumber};
  Moments angles;
  Moments errors;
  for (const double angle : angles_rad) {
    const double near_truth = unwrapped(angle, truth_rad);
    angles.add(near_truth);
    errors.add(std::abs(near_truth - truth_rad));
  }
  return {angles.mean(), angles.deviation(), errors.mean()};
}

Reproduced reproduced(const Row& row) {
  const auto near = [&](double Statistics::*figure) {
    const double difference = row.published.*figure - row.paper.expected.*figure;
    return std::abs(difference) <= 2 * row.paper.spread.*figure;
  };
  return {near(&Statistics::mean), near(&Statistics::deviation), near(&Statistics::mean_error)};
}

double rms_difference(const TableTwo& table) {
  double squares = 0;
  for (const Row& row : table.rows) {
    const double apart = distance(row.published, row.paper.expected);
    squares += apart * apart;
  }
  return std::sqrt(squares / (3 * kRows));
}

std::string as_printed(double figure) {
  const bool three = std::abs(std::remainder(figure, 1e-3)) < 1e-9;
  return fmt::format("{:.{}f}", figure, three ? 3 : 4);
}

TableTwo table_two(const Parameters& parameters, std::uint64_t runs) {
  TableTwo table{};
  std::array<RowStatistics, kRows> paper;
  std::array<RowStatistics, kRows> direct;
  for (std::uint64_t number = 0; number < runs; ++number) {
    const Experiment run = run_experiment(parameters, number);
    audit_run(run, parameters.sensor.counts_per_newton, table.audit);
    for (std::size_t row = 0; row < kRows; ++row) {
      paper[row].add(statistics_of_row(run, row, &Trial::paper));
      direct[row].add(statistics_of_row(run, row, &Trial::direct));
    }
  }
  for (std::size_t row = 0; row < kRows; ++row) {
    table.rows[row] = {kSites[row / 2],  is_phi(row) ? "phi" : "theta",
                       truth_of(row),    kPublished[row],
                       paper[row].all(), direct[row].all()};
  }
  return table;
}

std::vector<ScanPoint> scan_dead_zones(const Parameters& parameters, std::uint64_t runs) {
  std::vector<ScanPoint> points;
  for (int tenths = 0; tenths <= 100; ++tenths) {
    const double dead_zone_n = 0.1 * tenths;
    Parameters tried = parameters;
    tried.sensor.dead_zone_counts = dead_zone_n * tried.sensor.counts_per_newton;
    const Statistics expected = table_two(tried, runs).rows[kThetaInRegion1].paper.expected;
    points.push_back({dead_zone_n, expected, distance(expected, kPublished[kThetaInRegion1])});
  }
  return points;
}

}  // namespace pillarfield::testbed
