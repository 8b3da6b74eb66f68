#pragma once

#include <functional>
#include <map>
#include <string>

namespace pillarfield::bench {

/// Result of a case.
struct Measurement {
  double seconds = 0;  ///< median time of a frame
  std::map<std::string, double> counters;
  std::string label;
};

/// Registers a case. `measure` runs when the case is selected; an exception becomes its error.
void add_case(const std::string& name, std::function<Measurement()> measure);

}  // namespace pillarfield::bench
