// Where and how the speeds were measured.

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <string>

#include "report/speed/section.h"
#include "report/table.h"

namespace pillarfield::report {
namespace {

constexpr const char* kHow = R"(## How it was measured

    ./dev report speed

builds the release, runs `pillarfield-bench` ([benchmark.md](benchmark.md)), measures the errors on the frames that were timed, and
writes this page: about six minutes once all is built. Times differ from run to run; errors do not.

**Ratios within one run.** What a row compares runs by turns in one process, a few milliseconds each, so that whatever slows the
machine slows all of it; a ratio is the median of the ratios within the rounds. The nanoseconds say what that was on this machine.

**The ceiling** of a solve is a kernel that reads the streams of its plan and writes its result planes, launched in the same way, and
computes nothing. Of its kinds (stores by way of the caches or past them) the fastest counts. *Share of the ceiling* is its time over
that of the solve: 1 is a solve for the price of a copy.

**The frames** rotate, 32 to 64 of them, or as many as a gibibyte holds, no two alike. Where nothing else is said they are of a square metre,
790 × 790 pillars of uint8 sensels, all of it pressed from all directions, and *bare* means that forces and status bytes are all that is asked for.

)";

/// The text after `key` in a file of lines "key<separator>value"; empty where there is none.
std::string value_in(const char* path, const std::string& key, char separator) {
  std::ifstream file(path);
  std::string line;
  while (std::getline(file, line)) {
    if (!line.starts_with(key)) continue;
    const std::size_t from = line.find_first_not_of(" \t\"", line.find(separator) + 1);
    const std::size_t to = line.find_last_not_of(" \t\"");
    if (from != std::string::npos) return line.substr(from, to - from + 1);
  }
  return "";
}

std::string known(const std::string& text) { return text.empty() ? "not told" : text; }

std::string operating_system() {
  std::ifstream file("/proc/sys/kernel/osrelease");
  std::string kernel;
  std::getline(file, kernel);
  return fmt::format("{}, kernel {}", known(value_in("/etc/os-release", "PRETTY_NAME", '=')),
                     known(kernel));
}

/// "1.20, 0.80, 0.50": of the last minute, five and fifteen.
std::string load_now() {
  std::array<double, 3> loads{};
  if (getloadavg(loads.data(), 3) != 3) return "";
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", loads[0], loads[1], loads[2]);
}

/// "[1.2,0.8,0.5]", as JSON has it, in the same form.
std::string load_before(const BenchRun& bench) {
  std::array<double, 3> loads{};
  const std::string text = bench.context("load_avg");
  if (std::sscanf(text.c_str(), "[%lf,%lf,%lf", loads.data(), &loads[1], &loads[2]) != 3) return "";
  return fmt::format("{:.2f}, {:.2f}, {:.2f}", loads[0], loads[1], loads[2]);
}

}  // namespace

std::string machine_section(const SpeedContext& context) {
  const BenchRun& bench = context.run.bench;
  Table table("ll", {"", ""});
  table.add({"Date", bench.context("date")});
  table.add({"Commit", known(bench.context("commit"))});
  table.add({"Processor",
             fmt::format("{}, {} cores, {}", known(value_in("/proc/cpuinfo", "model name", ':')),
                         bench.context("num_cpus"), bench.context("caches"))});
  table.add({"System", operating_system()});
  table.add({"OpenCL device", fmt::format("{}; {}, driver {}", bench.context("device"),
                                          bench.context("platform"), bench.context("driver"))});
  table.add({"Pillars at once (lanes)", bench.context("lanes")});
  table.add({"Compiler", fmt::format("{}, {}", bench.context("compiler"), bench.context("build"))});
  table.add({"Load average before (1, 5, 15 min)", known(load_before(bench))});
  table.add({"Load average after", fmt::format("{}; the measurement itself keeps all {} cores busy",
                                               known(load_now()), bench.context("num_cpus"))});
  return kHow + table.text();
}

}  // namespace pillarfield::report
