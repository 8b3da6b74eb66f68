// pillarfield-bench: speed of the solve, relative to a copy of the same bytes and to baselines.
// Exit status: 0 done, 1 a case failed, 2 the command line was wrong.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cases/cases.h"
#include "pillarfield/error.h"

namespace pillarfield::bench {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

constexpr const char* kHelp = R"(Measures how fast frames are solved (docs/benchmark.md).

Usage: pillarfield-bench [OPTIONS]

  --benchmark_filter=REGEX       only cases whose name matches; --benchmark_list_tests lists them
  --benchmark_format=FORMAT      console or json, to standard output
  --benchmark_repetitions=N      run every case N times, then print mean, median and deviation
  --device=INDEX|NAME|host       the device, as for `pillarfield solve`
  --seconds=S                    minimum time of a case, above 0 (default 1)
  --help                         print this help

  Further options are those of Google Benchmark 1.7: --benchmark_out=FILE, --benchmark_color=BOOL,
  --benchmark_counters_tabular=BOOL, --benchmark_enable_random_interleaving=BOOL, ...

Cases: limit/ size/ contact/ regions/ type/ lanes/ stage/ sensor/ latency/ throughput/
       baseline/ field/

Try:  pillarfield-bench --benchmark_filter=size/
      pillarfield-bench --benchmark_filter=baseline/ --seconds=5
)";

/// The reporter that the command line selects, without the suffix "/manual_time" of names.
class UnsuffixedReporter final : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override {
    inner_->SetOutputStream(&GetOutputStream());
    inner_->SetErrorStream(&GetErrorStream());
    return inner_->ReportContext(context);
  }
  void ReportRuns(const std::vector<Run>& runs) override {
    std::vector<Run> plain = runs;
    for (Run& run : plain) {
      run.run_name.time_type.clear();
      any_failed_ = any_failed_ || run.error_occurred;
    }
    inner_->ReportRuns(plain);
  }
  void Finalize() override { inner_->Finalize(); }

  /// True after a case failed.
  [[nodiscard]] bool any_failed() const { return any_failed_; }

 private:
  std::unique_ptr<benchmark::BenchmarkReporter> inner_{benchmark::CreateDefaultDisplayReporter()};
  bool any_failed_ = false;
};

/// Options beside those of Google Benchmark.
struct Arguments {
  std::string device;
  double seconds = 1;
};

/// Parses `--name=value`; false where `word` is another option.
bool take(std::string_view word, std::string_view name, std::string_view& value) {
  const std::string prefix = fmt::format("--{}=", name);
  if (!word.starts_with(prefix)) return false;
  value = word.substr(prefix.size());
  return true;
}

double parse_seconds(std::string_view text) {
  double seconds = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, seconds);
  if (parsed.ec != std::errc{} || parsed.ptr != end || !(seconds > 0 && seconds <= 3600)) {
    throw Error("--seconds", fmt::format("'{}' is not a time", text),
                "give seconds above 0 and at most 3600");
  }
  return seconds;
}

/// Removes these options from `words`; the others remain.
Arguments take_arguments(std::vector<char*>& words) {
  Arguments arguments;
  std::erase_if(words, [&](const char* word) {
    std::string_view value;
    if (take(word, "device", value)) {
      arguments.device = value;
    } else if (take(word, "seconds", value)) {
      arguments.seconds = parse_seconds(value);
    } else {
      return false;
    }
    return true;
  });
  return arguments;
}

void print_help() {
  std::fputs(kHelp, stdout);
  std::exit(kDone);  // NOLINT(concurrency-mt-unsafe): no thread was started.
}

void add_context(const Device& device) {
  const DeviceInfo& info = device.info();
  benchmark::AddCustomContext("device", fmt::format("{} ({})", info.name, info.type));
  benchmark::AddCustomContext("driver", info.version);
  benchmark::AddCustomContext("platform", info.platform);
  benchmark::AddCustomContext("lanes", fmt::format("{}", info.lanes));
  benchmark::AddCustomContext("shares_memory", info.shares_memory ? "true" : "false");
  benchmark::AddCustomContext("compiler", PILLARFIELD_COMPILER);
  benchmark::AddCustomContext("build", PILLARFIELD_BUILD_TYPE);
}

/// Google Benchmark appends "/manual_time" to names, which the reporter hides: `$` matches before
/// the suffix.
std::string case_filter(const std::string& filter) {
  return std::regex_replace(filter, std::regex(R"(\$)"), "/manual_time$$");
}

/// Passes the other options to Google Benchmark; false where one is unknown to it.
bool initialize(std::vector<char*> words) {
  // A case repeats by itself: the library must run it once.
  std::string one_iteration = "--benchmark_min_time=1e-9";
  words.insert(words.begin() + 1, one_iteration.data());
  int count = static_cast<int>(words.size());
  words.push_back(nullptr);
  benchmark::Initialize(&count, words.data(), print_help);
  return !benchmark::ReportUnrecognizedArguments(count, words.data());
}

int run(const Arguments& arguments) {
  const bool is_opencl = !arguments.device.empty() && arguments.device != "host";
  Session session{
      open_device(arguments.device), open_device(is_opencl ? arguments.device : "opencl"), {}};
  session.length.seconds = arguments.seconds;
  add_context(session.device);
  for (const auto add : {add_limit_cases, add_size_cases, add_plan_cases, add_time_cases,
                         add_baseline_cases, add_field_cases}) {
    add(session);
  }
  UnsuffixedReporter reporter;
  const std::size_t cases =
      benchmark::RunSpecifiedBenchmarks(&reporter, case_filter(benchmark::GetBenchmarkFilter()));
  benchmark::Shutdown();
  return cases == 0 || reporter.any_failed() ? kFailed : kDone;
}

int complain(const std::exception& error, int status) {
  std::fprintf(stderr, "pillarfield-bench: %s\n", error.what());
  return status;
}

}  // namespace
}  // namespace pillarfield::bench

int main(int argc, char** argv) {
  using namespace pillarfield::bench;  // NOLINT(google-build-using-namespace)
  std::vector<char*> words(argv, argv + argc);
  Arguments arguments;
  try {
    arguments = take_arguments(words);
  } catch (const std::exception& error) {
    return complain(error, kWrongCommandLine);
  }
  if (!initialize(words)) return kWrongCommandLine;
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    return complain(error, kFailed);
  }
}
