#pragma once

#include <benchmark/benchmark.h>

#include <memory>

namespace pillarfield::bench {

/// The reporter that the command line selects, without the suffix "/manual_time" of names.
class UnsuffixedReporter final : public benchmark::BenchmarkReporter {
 public:
  UnsuffixedReporter();

  bool ReportContext(const Context& context) override;
  void ReportRuns(const std::vector<Run>& runs) override;
  void Finalize() override;

  /// True after a case failed.
  [[nodiscard]] bool any_failed() const { return any_failed_; }

 private:
  std::unique_ptr<benchmark::BenchmarkReporter> inner_;
  bool any_failed_ = false;
};

}  // namespace pillarfield::bench
