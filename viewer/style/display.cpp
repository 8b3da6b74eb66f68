#include "viewer/style/display.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "pillarfield/force_field.h"
#include "viewer/style/ticks.h"

namespace pillarfield::viewer {
namespace {

constexpr double kDegrees = 180 / std::numbers::pi;
constexpr int kMostDecimals = 6;

bool is_bounded(double value) { return std::abs(value) < 0.1 * kOpenN; }  // false for NaN

bool tells(double deviation) { return is_bounded(deviation) && deviation > 0; }

/// Number of decimals that show two digits of `size`.
int decimals_of(double size) {
  const int first = static_cast<int>(std::floor(std::log10(size)));
  return std::clamp(1 - first, 0, kMostDecimals);
}

std::string with_decimals(double value, int decimals) {
  if (!is_bounded(value)) return "–";
  const std::string text = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool zero = text.find_first_not_of("0.") == std::string::npos;
  return value < 0 && !zero ? "\u2212" + text : text;
}

std::string value_words(double value, double deviation) {
  if (!tells(deviation)) return three_digits(value);
  return with_decimals(value, decimals_of(deviation));
}

}  // namespace

Unit Units::of(Dimension dimension) const {
  if (dimension == Dimension::pressure) return {pressure.name, 1 / pressure.kpa};
  static constexpr std::array<Unit, 9> kUnits{
      {{}, {"counts"}, {"N"}, {}, {"N mm"}, {"mm"}, {"mm²"}, {"°", kDegrees}, {"s"}}};
  return kUnits.at(static_cast<std::size_t>(dimension));
}

std::string with_unit(const std::string& number, std::string_view unit) {
  return fmt::format("{}{}{}", number, unit.empty() || unit == "°" ? "" : " ", unit);
}

std::string Units::title(std::string_view words, Dimension dimension) const {
  const std::string_view unit = of(dimension).name;
  return fmt::format("{}{}{}", words, unit.empty() ? "" : ", ", unit);
}

std::string Units::number(Dimension dimension, double value) const {
  return three_digits(shown(dimension, value));
}

std::string Units::text(Dimension dimension, double value) const {
  return with_unit(number(dimension, value), of(dimension).name);
}

std::string Units::plain(Dimension dimension, double value) const {
  return with_unit(fmt::format("{:g}", shown(dimension, value)), of(dimension).name);
}

std::string Units::fixed(Dimension dimension, double value, int decimals) const {
  return with_unit(with_decimals(shown(dimension, value), decimals), of(dimension).name);
}

ShownValue Units::readout(std::string label, Dimension dimension, double value,
                          double deviation) const {
  const auto [unit, factor] = of(dimension);
  deviation *= factor;
  const std::string range =
      tells(deviation) ? "± " + with_decimals(deviation, decimals_of(deviation)) : "";
  return {std::move(label), value_words(factor * value, deviation), range, std::string(unit)};
}

ShownValue Units::readout_between(std::string label, Dimension dimension, double value, double low,
                                  double high) const {
  const auto [unit, factor] = of(dimension);
  const double width = factor * (high - low);
  std::string range;
  if (is_bounded(low) && is_bounded(high)) {
    const int decimals = width > 0 ? decimals_of(width) : 3;
    range = with_decimals(factor * low, decimals) + " … " + with_decimals(factor * high, decimals);
  }
  return {std::move(label), value_words(factor * value, width), range, std::string(unit)};
}

}  // namespace pillarfield::viewer
