#pragma once

#include <functional>
#include <map>
#include <string>

namespace pillarfield::bench {

/// What a row of the table says.
struct Measurement {
  double seconds = 0;  ///< of one frame, the median
  std::map<std::string, double> counters;
  std::string label;
};

/// Adds a row, whose measurement is taken when its name is asked for. What it throws becomes the
/// row's error.
void add_row(const std::string& name, std::function<Measurement()> measure);

}  // namespace pillarfield::bench
