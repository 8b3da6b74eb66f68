#include "report/speed/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "pillarfield/error.h"

namespace pillarfield::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kMeasureAnew = "measure anew with ./dev report speed";

/// What is read of a JSON text, every complaint about it being an Error.
template <class Read>
auto read_json(const std::string& name, const std::string& text, Read read) {
  try {
    return read(Json::parse(text));
  } catch (const Json::exception& error) {
    throw Error(name, fmt::format("is not what it should be: {}", error.what()), kMeasureAnew);
  }
}

std::string text_of(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// "32 KiB data, 1 MiB, 32 MiB": the caches of a core from the nearest on; of the code none.
std::string caches_text(const Json& caches) {
  std::string text;
  for (const Json& cache : caches) {
    if (cache.at("type") == "Instruction") continue;
    constexpr int kMebi = 1 << 20;
    const auto bytes = cache.at("size").get<int>();
    const std::string size =
        bytes >= kMebi ? fmt::format("{} MiB", bytes / kMebi) : fmt::format("{} KiB", bytes / 1024);
    const int sharing = cache.at("num_sharing").get<int>();
    text += fmt::format("{}level {}: {}{}", text.empty() ? "" : ", ", cache.at("level").get<int>(),
                        size, sharing > 1 ? fmt::format(" for {} cores", sharing) : "");
  }
  return text;
}

std::optional<double> milliseconds(const Json& value) {
  if (value.is_null()) return std::nullopt;
  return value.get<double>();
}

LiveRun live_run_of(const Json& json) {
  LiveRun run;
  run.source = json.at("source").get<std::string>();
  run.pillars =
      json.at("pillar_rows").get<std::uint64_t>() * json.at("pillar_cols").get<std::uint64_t>();
  run.rate_hz = json.at("rate_hz").get<double>();
  run.seconds = json.at("seconds").get<double>();
  run.deadline_ms = json.at("deadline_ms").get<double>();
  run.scheduled = json.at("scheduled").get<std::uint64_t>();
  run.dropped = json.at("dropped").get<std::uint64_t>();
  run.missed = json.at("missed").get<std::uint64_t>();
  run.p50_ms = milliseconds(json.at("latency_p50_ms"));
  run.p99_ms = milliseconds(json.at("latency_p99_ms"));
  run.p99_9_ms = milliseconds(json.at("latency_p99_9_ms"));
  run.longest_ms = milliseconds(json.at("latency_longest_ms"));
  run.contact_share = json.at("contact_share").get<double>();
  run.cpu_cores = json.at("cpu_cores").get<double>();
  for (const Json& bin : json.at("latency_histogram")) {
    run.histogram.push_back({bin.at("from_ms").get<double>(), bin.at("to_ms").get<double>(),
                             bin.at("frames").get<std::uint64_t>()});
  }
  return run;
}

std::string text_in(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(file)), {});
  if (!file) throw Error(path.string(), "cannot be read", kMeasureAnew);
  return text;
}

}  // namespace

BenchRun::BenchRun(std::string name, const std::string& json) : name_(std::move(name)) {
  read_json(name_, json, [this](const Json& run) {
    for (const auto& [key, value] : run.at("context").items()) {
      context_[key] = key == "caches" ? caches_text(value) : text_of(value);
    }
    for (const Json& told : run.at("benchmarks")) {
      if (told.value("run_type", "iteration") != "iteration") continue;
      Row row;
      row.name = told.at("name").get<std::string>();
      row.label = told.value("label", "");
      if (told.value("error_occurred", false)) row.left_out = told.value("error_message", "failed");
      for (const auto& [key, value] : told.items()) {
        if (value.is_number()) row.counters[key] = value.get<double>();
      }
      rows_.push_back(std::move(row));
    }
  });
}

double BenchRun::value(const std::string& row, const std::string& counter) const {
  const auto& all = counters(row);
  const auto found = all.find(counter);
  if (found == all.end()) {
    throw Error(name_, fmt::format("the row '{}' has no '{}'", row, counter), kMeasureAnew);
  }
  return found->second;
}

std::optional<double> BenchRun::find(const std::string& row, const std::string& counter) const {
  const Row* const found = this->row(row);
  if (found == nullptr || !found->left_out.empty()) return std::nullopt;
  return value(row, counter);
}

const std::string& BenchRun::label(const std::string& row) const { return required(row).label; }

const std::string& BenchRun::why_left_out(const std::string& row) const {
  return required(row).left_out;
}

std::vector<std::string> BenchRun::rows_of(std::string_view group) const {
  const std::string beginning = fmt::format("{}/", group);
  std::vector<std::string> names;
  for (const Row& row : rows_) {
    if (row.name.starts_with(beginning)) names.push_back(row.name);
  }
  return names;
}

const std::map<std::string, double>& BenchRun::counters(const std::string& row) const {
  const Row& found = required(row);
  if (!found.left_out.empty()) {
    throw Error(name_, fmt::format("the row '{}' was not measured: {}", row, found.left_out));
  }
  return found.counters;
}

std::string BenchRun::context(const std::string& key) const {
  const auto found = context_.find(key);
  return found == context_.end() ? "" : found->second;
}

const BenchRun::Row* BenchRun::row(const std::string& row) const {
  const auto found = std::ranges::find(rows_, row, &Row::name);
  return found == rows_.end() ? nullptr : &*found;
}

const BenchRun::Row& BenchRun::required(const std::string& row) const {
  const Row* const found = this->row(row);
  if (found == nullptr) {
    throw Error(name_, fmt::format("there is no row '{}'", row), kMeasureAnew);
  }
  return *found;
}

LiveRun parse_live_run(const std::string& name, const std::string& json) {
  return read_json(name, json, live_run_of);
}

SpeedRun read_speed_run(const std::filesystem::path& bench,
                        const std::optional<std::filesystem::path>& live) {
  SpeedRun run = {BenchRun(bench.string(), text_in(bench)), std::nullopt};
  if (live) run.live = parse_live_run(live->string(), text_in(*live));
  return run;
}

}  // namespace pillarfield::report
