#include "bench/timing/plain_names.h"

namespace pillarfield::bench {

PlainNames::PlainNames() : inner_(benchmark::CreateDefaultDisplayReporter()) {}

bool PlainNames::ReportContext(const Context& context) {
  inner_->SetOutputStream(&GetOutputStream());
  inner_->SetErrorStream(&GetErrorStream());
  return inner_->ReportContext(context);
}

void PlainNames::ReportRuns(const std::vector<Run>& runs) {
  std::vector<Run> plain = runs;
  for (Run& run : plain) {
    run.run_name.time_type.clear();
    any_failed_ = any_failed_ || (run.error_occurred && !run.error_message.starts_with(kSkipped));
  }
  inner_->ReportRuns(plain);
}

void PlainNames::Finalize() { inner_->Finalize(); }

}  // namespace pillarfield::bench
