#pragma once

#include <map>
#include <string>

#include "report/speed/run.h"

namespace pillarfield::report {

/// A run of pillarfield-bench that nobody made: `rows` are the members of each row's JSON beside
/// its name.
inline BenchRun made_up_run(const std::map<std::string, std::string>& rows) {
  std::string text;
  for (const auto& [name, members] : rows) {
    if (!text.empty()) text += ",";
    text += R"({"run_type":"iteration","name":")";
    text += name;
    text += "\",";
    text += members;
    text += "}";
  }
  return {"made_up.json",
          R"({"context":{"device":"none","num_cpus":2},"benchmarks":[)" + text + "]}"};
}

}  // namespace pillarfield::report
