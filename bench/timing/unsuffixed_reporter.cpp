#include "bench/timing/unsuffixed_reporter.h"

namespace pillarfield::bench {

UnsuffixedReporter::UnsuffixedReporter() : inner_(benchmark::CreateDefaultDisplayReporter()) {}

bool UnsuffixedReporter::ReportContext(const Context& context) {
  inner_->SetOutputStream(&GetOutputStream());
  inner_->SetErrorStream(&GetErrorStream());
  return inner_->ReportContext(context);
}

void UnsuffixedReporter::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> plain = runs;
  for (Run& run : plain) {
    run.run_name.time_type.clear();
    any_failed_ = any_failed_ || run.error_occurred;
  }
  inner_->ReportRuns(plain);
}

void UnsuffixedReporter::Finalize() { inner_->Finalize(); }

}  // namespace pillarfield::bench
