// pillarfield testbed: the paper's experiment on one pillar.

#include "testbed/testbed.h"

#include <fmt/format.h>

#include <array>
#include <span>
#include <string_view>

#include "cli/commands.h"
#include "cli/json_text.h"
#include "pillarfield/printable.h"
#include "testbed/figures.h"
#include "testbed/magnitude.h"
#include "testbed/table_two.h"

namespace pillarfield::cli {
namespace {

using Json = nlohmann::ordered_json;
using testbed::MagnitudeFigure;
using testbed::Statistics;
using testbed::TableTwo;

Json json_of(const Statistics& statistics) {
  return {{"mean", statistics.mean},
          {"deviation", statistics.deviation},
          {"mean_error", statistics.mean_error}};
}

Json json_of(const testbed::RowEstimate& estimate) {
  return {{"run", json_of(estimate.run)},
          {"expected", json_of(estimate.expected)},
          {"spread", json_of(estimate.spread)}};
}

Json json_of(const testbed::Row& row) {
  const testbed::Reproduced reproduced = testbed::reproduced(row);
  return {{"site", row.site.name},
          {"angle", row.angle},
          {"truth", row.truth_rad},
          {"published", json_of(row.published)},
          {"paper", json_of(row.paper)},
          {"direct", json_of(row.direct)},
          {"reproduced",
           {{"mean", reproduced.mean},
            {"deviation", reproduced.deviation},
            {"mean_error", reproduced.mean_error}}}};
}

Json json_of(const PillarSensor& sensor) {
  return {{"counts_per_newton", sensor.counts_per_newton},
          {"threshold_counts", sensor.threshold_counts},
          {"dead_zone_counts", sensor.dead_zone_counts},
          {"full_scale_counts", sensor.full_scale_counts.value_or(0)},
          {"noise_counts", sensor.noise_counts}};
}

Json json_of(const MagnitudeFigure& figure) {
  Json points = Json::array();
  for (std::size_t site = 0; site < figure.size(); ++site) {
    for (const testbed::MagnitudePoint& point : figure[site]) {
      points.push_back({{"site", testbed::kSites[site].name},
                        {"applied_n", point.applied_n},
                        {"uncertain_low_n", point.uncertain.low},
                        {"uncertain_high_n", point.uncertain.high},
                        {"paper_n", point.paper_n},
                        {"direct_n", point.direct_n},
                        {"possible_low_n", point.possible.low},
                        {"possible_high_n", point.possible.high},
                        {"ambiguous", point.ambiguous}});
    }
  }
  return points;
}

void print_json(const TestbedOptions& options, const TableTwo& table,
                const MagnitudeFigure& figure) {
  const testbed::Parameters& parameters = options.parameters;
  Json rows = Json::array();
  for (const testbed::Row& row : table.rows) rows.push_back(json_of(row));
  const Json result = {{"sensor", json_of(parameters.sensor)},
                       {"positioner_rad", parameters.positioner_rad},
                       {"play_rad", parameters.play_rad},
                       {"probe_resolution_n", parameters.probe_resolution_n},
                       {"seed", parameters.seed},
                       {"runs", options.runs},
                       {"table_2", rows},
                       {"forces", table.audit.trials},
                       {"wrong_regions", table.audit.wrong_regions},
                       {"unflagged", table.audit.unflagged},
                       {"figure_8", json_of(figure)}};
  fmt::print("{}\n", json_text(result));
}

void print_setup(const TestbedOptions& options) {
  const testbed::Parameters& parameters = options.parameters;
  const PillarSensor& sensor = parameters.sensor;
  fmt::print(
      "One pillar, pressed from three directions with 10 to 100 N: the testbed of the paper.\n"
      "Sensor: {} counts per newton (our choice, the paper gives none), dead zone {} counts\n"
      "({:.3g} N), threshold {}, noise {}, full scale {}. Probe: angles to {} rad, play {} rad,\n"
      "force to {} N. Seed {}.\n\n",
      sensor.counts_per_newton, sensor.dead_zone_counts,
      sensor.dead_zone_counts / sensor.counts_per_newton, sensor.threshold_counts,
      sensor.noise_counts, sensor.full_scale_counts.value_or(0), parameters.positioner_rad,
      parameters.play_rad, parameters.probe_resolution_n, parameters.seed);
}

void print_head(const std::string& title, std::span<const char* const> columns, int width) {
  fmt::print("{}\n{:<22}", title, "");
  for (const char* column : columns) fmt::print(" | {:<{}}", column, 3 * width - 1);
  fmt::print("\n{:<9} {:<5} {:>6}", "rad", "", "truth");
  for (std::size_t column = 0; column < columns.size(); ++column) {
    fmt::print(" | {:<{}}{:<{}}{:<{}}", "mean", width, "SD", width, "error", width - 1);
  }
  fmt::print("\n");
}

void print_name(const testbed::Row& row) {
  const bool first = row.angle == std::string_view("phi");
  fmt::print("{:<9} {:<5} {:>6.3f}", first ? row.site.name : "", row.angle, row.truth_rad);
}

void print_run(const TableTwo& table) {
  print_head("Table II: one run, as in the paper",
             std::array{"printed by the paper", "the paper's equations", "direct"}, 7);
  for (const testbed::Row& row : table.rows) {
    print_name(row);
    fmt::print(" | {:<7}{:<7}{:<6}", testbed::as_printed(row.published.mean),
               testbed::as_printed(row.published.deviation),
               testbed::as_printed(row.published.mean_error));
    for (const Statistics& column : {row.paper.run, row.direct.run}) {
      fmt::print(" | {:<7.3f}{:<7.3f}{:<6.3f}", column.mean, column.deviation, column.mean_error);
    }
    fmt::print("\n");
  }
}

/// Returns a text such as "0.624 ±0.028*", with the mark if `marked`.
std::string with_spread(double expected, double spread, bool marked) {
  return fmt::format("{:.3f} ±{:.3f}{}", expected, spread, marked ? '*' : ' ');
}

void print_estimate(const testbed::RowEstimate& estimate, testbed::Reproduced marked) {
  fmt::print(
      " | {} {} {}", with_spread(estimate.expected.mean, estimate.spread.mean, marked.mean),
      with_spread(estimate.expected.deviation, estimate.spread.deviation, marked.deviation),
      with_spread(estimate.expected.mean_error, estimate.spread.mean_error, marked.mean_error));
}

void print_expected(const TableTwo& table, std::uint64_t runs) {
  print_head(
      fmt::format("\nExpected in one run, ± its standard deviation over {} runs. *: the paper's "
                  "figure is within two of these",
                  runs),
      std::array{"the paper's equations", "direct"}, 14);
  for (const testbed::Row& row : table.rows) {
    print_name(row);
    print_estimate(row.paper, testbed::reproduced(row));
    print_estimate(row.direct, {false, false, false});
    fmt::print("\n");
  }
  fmt::print(
      "\n{} of {} forces are in another region than in the ideal model; {} of these lack the "
      "status\n"
      "bit ambiguous or inconsistent. Error: mean of |angle - truth|.\n",
      table.audit.wrong_regions, table.audit.trials, table.audit.unflagged);
}

void print_magnitudes(const MagnitudeFigure& figure) {
  fmt::print(
      "\nFigure 8: calculated magnitude, N. Uncertain: range of the applied force from the\n"
      "uncertainty of the angles. Possible: interval of an ambiguous force.\n"
      "{:<9} {:>7}   {:<15}   {:>7} {:>7}   {}\n",
      "", "applied", "uncertain", "paper", "direct", "possible");
  for (std::size_t site = 0; site < figure.size(); ++site) {
    const char* name = testbed::kSites[site].name;
    for (const testbed::MagnitudePoint& point : figure[site]) {
      fmt::print("{:<9} {:>7.0f}   {:>6.1f} to {:>5.1f}   {:>7.2f} {:>7.2f}", name, point.applied_n,
                 point.uncertain.low, point.uncertain.high, point.paper_n, point.direct_n);
      if (point.possible.low < point.possible.high) {
        fmt::print("   {:.1f} to {:.1f}", point.possible.low, point.possible.high);
      }
      fmt::print("\n");
      name = "";
    }
  }
}

}  // namespace

void run_testbed(const TestbedOptions& options) {
  const testbed::Parameters& parameters = options.parameters;
  testbed::check(parameters);
  if (!options.figures.empty()) {
    testbed::draw_figures(options.figures, parameters, options.replace);
  }
  const TableTwo table = testbed::table_two(parameters, options.runs);
  const MagnitudeFigure figure = testbed::magnitude_figure(parameters);
  if (options.json) {
    print_json(options, table, figure);
    return;
  }
  print_setup(options);
  print_run(table);
  print_expected(table, options.runs);
  print_magnitudes(figure);
  if (!options.figures.empty())
    fmt::print("\nDrew Figures 3, 4, 5 and 8 in {}\n", printable(options.figures));
}

}  // namespace pillarfield::cli
