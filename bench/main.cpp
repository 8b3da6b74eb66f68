// pillarfield-bench: how fast frames are solved, beside the copy of the same bytes and beside
// others. Exit status: 0 done, 1 a row failed, 2 the command line was wrong.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "bench/cases/rows.h"
#include "bench/timing/plain_names.h"
#include "device/device_state.h"
#include "pillarfield/error.h"

namespace pillarfield::bench {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongCommandLine = 2;

constexpr const char* kHelp = R"(Measures how fast frames are solved (docs/benchmark.md).

Usage: pillarfield-bench [OPTIONS]

  --benchmark_filter=REGEX       only the rows whose name matches; --benchmark_list_tests lists them
  --benchmark_format=FORMAT      console or json, to standard output
  --benchmark_repetitions=N      every row N times, then mean, median and deviation
  --device=INDEX|NAME            an OpenCL device, as for `pillarfield solve`
  --seconds=S                    least time of a row's race, above 0 (default 1)
  --help                         this

  Further options are those of Google Benchmark 1.7: --benchmark_out=FILE, --benchmark_color=BOOL,
  --benchmark_counters_tabular=BOOL, --benchmark_enable_random_interleaving=BOOL, ...

Rows: ceiling/ size/ contact/ regions/ type/ output/ estimator/ lanes/ stage/ latency/ throughput/
      opponent/ by_hand/ spread/ variant/ field/ render/

Try:  pillarfield-bench --benchmark_filter=size/
      pillarfield-bench --benchmark_filter=opponent/ --seconds=5
)";

/// What is asked for beside Google Benchmark's own options.
struct Arguments {
  std::string device;
  double seconds = 1;
};

/// Takes out `--name=value`; false where the word is another.
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
    throw Error("--seconds", fmt::format("'{}' is no time", text),
                "give seconds above 0, 3600 at most");
  }
  return seconds;
}

/// Takes our options out of `words`; the others stay.
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

void tell_context(const Device& device) {
  const DeviceInfo& info = device.info();
  benchmark::AddCustomContext("device", fmt::format("{} ({})", info.name, info.type));
  benchmark::AddCustomContext("driver", device.state().device.getInfo<CL_DRIVER_VERSION>());
  benchmark::AddCustomContext("platform", info.platform);
  benchmark::AddCustomContext("lanes", fmt::format("{}", info.lanes));
  benchmark::AddCustomContext("shares_memory", info.shares_memory ? "true" : "false");
  benchmark::AddCustomContext("compiler", PILLARFIELD_COMPILER);
  benchmark::AddCustomContext("build", PILLARFIELD_BUILD_TYPE);
}

/// Rows end in "/manual_time" for Google Benchmark, and in nothing for people: a `$` stands for
/// both ends.
std::string row_filter(const std::string& filter) {
  return std::regex_replace(filter, std::regex(R"(\$)"), "/manual_time$$");
}

/// Hands Google Benchmark its options; false where one is unknown to it too.
bool initialize(std::vector<char*> words) {
  // A row is one race: with the library's own time it would be repeated.
  std::string one_iteration = "--benchmark_min_time=1e-9";
  words.insert(words.begin() + 1, one_iteration.data());
  int count = static_cast<int>(words.size());
  words.push_back(nullptr);
  benchmark::Initialize(&count, words.data(), print_help);
  return !benchmark::ReportUnrecognizedArguments(count, words.data());
}

int run(const Arguments& arguments) {
  Session session{open_device(arguments.device), {}};
  session.length.seconds = arguments.seconds;
  tell_context(session.device);
  for (const auto add :
       {add_ceiling_rows, add_size_rows, add_plan_rows, add_time_rows, add_opponent_rows,
        add_by_hand_rows, add_spread_rows, add_variant_rows, add_field_rows, add_render_rows}) {
    add(session);
  }
  PlainNames reporter;
  const std::size_t rows =
      benchmark::RunSpecifiedBenchmarks(&reporter, row_filter(benchmark::GetBenchmarkFilter()));
  benchmark::Shutdown();
  return rows == 0 || reporter.any_failed() ? kFailed : kDone;
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
