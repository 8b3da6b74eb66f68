#pragma once

#include <benchmark/benchmark.h>

#include <memory>

namespace pillarfield::bench {

/// The reporter that the command line asks for, with the names of the rows as they were given:
/// without "/manual_time".
class PlainNames final : public benchmark::BenchmarkReporter {
 public:
  PlainNames();

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

  /// Whether a row had an error, other than that what it needs is not installed.
  [[nodiscard]] bool any_failed() const { return any_failed_; }

 private:
  std::unique_ptr<benchmark::BenchmarkReporter> inner_;
  bool any_failed_ = false;
};

/// What the error of a row begins with that was left out.
inline constexpr const char* kSkipped = "skipped: ";

}  // namespace pillarfield::bench
