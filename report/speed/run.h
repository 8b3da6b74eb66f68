#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pillarfield::report {

/// What `pillarfield-bench --benchmark_format=json` measured.
class BenchRun {
 public:
  /// Throws Error where the text is not of that format. `name` stands for it in messages.
  BenchRun(std::string name, const std::string& json);

  /// A counter of a row. Throws Error where the row is not there, was left out, or has no such
  /// counter.
  [[nodiscard]] double value(const std::string& row, const std::string& counter) const;

  /// The same, or nothing where the row is not there or was left out.
  [[nodiscard]] std::optional<double> find(const std::string& row,
                                           const std::string& counter) const;

  /// What the row says of itself. Throws Error where it is not there.
  [[nodiscard]] const std::string& label(const std::string& row) const;

  /// Why a row was left out, or empty. Throws Error where it is not there.
  [[nodiscard]] const std::string& why_left_out(const std::string& row) const;

  /// Names of the rows of a group such as "size", in their order.
  [[nodiscard]] std::vector<std::string> rows_of(std::string_view group) const;

  /// Counters of a row. Throws as value().
  [[nodiscard]] const std::map<std::string, double>& counters(const std::string& row) const;

  /// "device", "compiler", "date", ...; empty where it is not told.
  [[nodiscard]] std::string context(const std::string& key) const;

 private:
  struct Row {
    std::string name;
    std::string label;
    std::string left_out;
    std::map<std::string, double> counters;
  };
  [[nodiscard]] const Row* row(const std::string& row) const;
  [[nodiscard]] const Row& required(const std::string& row) const;

  std::string name_;
  std::vector<Row> rows_;
  std::map<std::string, std::string> context_;
};

/// What `pillarfield live --json` measured.
struct LiveRun {
  struct Bin {
    double from_ms = 0;
    double to_ms = 0;
    std::uint64_t frames = 0;
  };
  std::string source;
  std::uint64_t pillars = 0;
  double rate_hz = 0;
  double seconds = 0;
  double deadline_ms = 0;
  std::uint64_t scheduled = 0;
  std::uint64_t dropped = 0;
  std::uint64_t missed = 0;
  std::optional<double> p50_ms;  ///< unset: that frame never came
  std::optional<double> p99_ms;
  std::optional<double> p99_9_ms;
  std::optional<double> longest_ms;
  double contact_share = 0;
  double cpu_cores = 0;
  std::vector<Bin> histogram;
};

/// Throws Error where the text is not of that format.
[[nodiscard]] LiveRun parse_live_run(const std::string& name, const std::string& json);

/// All that was measured for the report.
struct SpeedRun {
  BenchRun bench;
  std::optional<LiveRun> live;
};

/// Reads the files; no path, no live run. Throws Error where one cannot be read.
[[nodiscard]] SpeedRun read_speed_run(const std::filesystem::path& bench,
                                      const std::optional<std::filesystem::path>& live);

}  // namespace pillarfield::report
