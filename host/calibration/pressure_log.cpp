#include "calibration/pressure_log.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "base/input_file.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::uint64_t kMostLogBytes = 256 << 20;

/// The finite number that is all of `text` but blanks around it; NaN otherwise.
double number_of(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? value : std::nan("");
}

}  // namespace

PressureLog::PressureLog(const std::string& file) {
  std::istringstream stream(InputFile(file, kMostLogBytes).text());
  std::string text;
  for (std::size_t number = 1; std::getline(stream, text); ++number) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (text.empty()) continue;
    const std::size_t comma = std::min(text.find(','), text.size());
    const Line line = {number_of(text.substr(0, comma)),
                       comma < text.size() ? number_of(text.substr(comma + 1)) : std::nan("")};
    if (number == 1 && std::isnan(line.time_s) && std::isnan(line.pressure_kpa)) continue;
    add(line, fmt::format("{}:{}", file, number));
  }
  if (lines_.empty()) throw Error(file, "has no pressure", "write lines such as 0.5,120");
}

PressureLog::PressureLog(const std::string& where, const std::vector<double>& times_s,
                         const std::vector<double>& pressures_kpa) {
  if (times_s.size() != pressures_kpa.size()) {
    throw Error(where,
                fmt::format("{} frames and {} pressures", times_s.size(), pressures_kpa.size()),
                "give one for each");
  }
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    add({times_s[i], pressures_kpa[i]}, fmt::format("{}, frame {}", where, i));
  }
}

void PressureLog::add(const Line& line, const std::string& where) {
  const bool valid = line.pressure_kpa >= 0 && !std::isnan(line.time_s);
  if (!valid || (!lines_.empty() && line.time_s <= lines_.back().time_s)) {
    throw Error(where, "is not a later time and a pressure",
                "write lines such as 0.5,120 with rising times in s and pressures in kPa");
  }
  lines_.push_back(line);
}

double PressureLog::at(double time_s) const {
  const auto after = std::ranges::upper_bound(lines_, time_s, {}, &Line::time_s);
  if (after == lines_.begin()) return lines_.front().pressure_kpa;
  if (after == lines_.end()) return lines_.back().pressure_kpa;
  const Line& before = *(after - 1);
  const double part = (time_s - before.time_s) / (after->time_s - before.time_s);
  return before.pressure_kpa + part * (after->pressure_kpa - before.pressure_kpa);
}

}  // namespace pillarfield
