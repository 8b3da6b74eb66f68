#include "viewer/app/loaded_source.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "pillarfield/printable.h"

namespace pillarfield::viewer {
namespace {

/// Shows the percentage of a simulation on the terminal's last line; clears it at the end.
class Progress {
 public:
  Progress() : shown_(isatty(STDERR_FILENO) == 1) {}
  ~Progress() {
    if (percent_ >= 0) std::fputs("\r                    \r", stderr);
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void tell(double share) {
    const int percent = static_cast<int>(std::floor(100 * share));
    if (!shown_ || percent == percent_) return;
    percent_ = percent;
    fmt::print(stderr, "\rsimulating {:3d} %", percent);
    std::fflush(stderr);
  }

 private:
  bool shown_;
  int percent_ = -1;
};

}  // namespace

ProducerOptions producer_options(const Options& options) {
  ProducerOptions wanted;
  wanted.device = options.device;
  wanted.read = options.plain;
  wanted.read.trust = options.trust_input;
  if (isatty(STDERR_FILENO) == 1) {
    wanted.on_compiling = [](const std::string& line) {
      fmt::print(stderr, "{}\n", printable(line));
    };
  }
  return wanted;
}

LoadedSource load_source(const Options& options, double scale) {
  std::unique_ptr<FieldProducer> producer;
  {
    Progress progress;
    producer = open_producer(options.source, producer_options(options),
                             [&](double share) { progress.tell(share); });
  }
  for (const std::string& warning : producer->info().warnings) {
    fmt::print(stderr, "pillarfield-viewer: {}\n",
               printable(fmt::format("{}: {}", producer->info().name, warning)));
  }
  LoadedSource loaded;
  loaded.settings = default_settings(options, *producer, scale);
  loaded.player = std::make_unique<Player>(std::move(producer));
  return loaded;
}

}  // namespace pillarfield::viewer
