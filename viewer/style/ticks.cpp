#include "viewer/style/ticks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <initializer_list>

namespace pillarfield::viewer {
namespace {

constexpr const char* kMinus = "\u2212";
constexpr int kMostDigits = 6;  ///< before or after the point, in a label without exponent

/// digits * 10^exponent
struct Decimal {
  std::int64_t digits;
  int exponent;
};

/// The double nearest to a decimal; divides, since powers of ten below one are not exact.
double value_of(Decimal decimal) {
  const auto digits = static_cast<double>(decimal.digits);
  const double power = std::pow(10.0, std::abs(decimal.exponent));
  return decimal.exponent < 0 ? digits / power : digits * power;
}

/// The least not below `value` of `steps` (ascending, within a power of ten) times a power of ten.
Decimal least_not_below(double value, std::initializer_list<int> steps) {
  for (int exponent = static_cast<int>(std::floor(std::log10(value))) - 2;; ++exponent) {
    for (const int digits : steps) {
      if (value_of({digits, exponent}) >= value) return {digits, exponent};
    }
  }
}

Decimal nice_at_least(double value) { return least_not_below(value, {1, 2, 5}); }

Decimal next_nicer(Decimal nice) {
  if (nice.digits == 5) return {1, nice.exponent + 1};
  return {nice.digits == 1 ? 2 : 5, nice.exponent};
}

/// Multiples of a step within [low, high], ascending.
std::vector<Decimal> multiples(Decimal step, double low, double high) {
  const double size = value_of(step);
  // One more at each end, since the divisions round.
  const auto first = static_cast<std::int64_t>(std::ceil(low / size)) - 1;
  const auto last = static_cast<std::int64_t>(std::floor(high / size)) + 1;
  std::vector<Decimal> found;
  for (std::int64_t i = first; i <= last; ++i) {
    const Decimal multiple{i * step.digits, step.exponent};
    const double value = value_of(multiple);
    if (low <= value && value <= high) found.push_back(multiple);
  }
  return found;
}

std::string with_minus(bool negative, const std::string& text) {
  return negative ? kMinus + text : text;
}

/// "1.5e7" for the digits "15" and exponent 7 of the first digit.
std::string with_exponent(std::string digits, int exponent) {
  if (digits.size() > 1) digits.insert(1, ".");
  return digits + "e" + with_minus(exponent < 0, std::to_string(std::abs(exponent)));
}

std::string plain_label(Decimal decimal) {
  const double size = std::abs(value_of(decimal));
  return with_minus(decimal.digits < 0,
                    fmt::format("{:.{}f}", size, std::max(0, -decimal.exponent)));
}

std::string exponent_label(Decimal decimal) {
  std::string digits = std::to_string(std::abs(decimal.digits));
  const int exponent = decimal.exponent + static_cast<int>(digits.size()) - 1;
  digits.erase(digits.find_last_not_of('0') + 1);
  return with_minus(decimal.digits < 0, with_exponent(digits, exponent));
}

/// True if all labels without exponent stay short.
bool are_plain(const std::vector<Decimal>& decimals) {
  return std::all_of(decimals.begin(), decimals.end(), [](Decimal decimal) {
    return decimal.exponent >= -kMostDigits &&
           std::abs(value_of(decimal)) < std::pow(10.0, kMostDigits);
  });
}

}  // namespace

std::vector<Tick> ticks(double low, double high, int most) {
  Decimal step = nice_at_least((high - low) / (most + 1));
  std::vector<Decimal> found = multiples(step, low, high);
  while (found.size() > static_cast<std::size_t>(most)) {
    step = next_nicer(step);
    found = multiples(step, low, high);
  }
  const bool plain = are_plain(found);
  std::vector<Tick> ticks;
  for (const Decimal& decimal : found) {
    const std::string label = plain ? plain_label(decimal) : exponent_label(decimal);
    ticks.push_back({value_of(decimal), decimal.digits == 0 ? "0" : label});
  }
  return ticks;
}

double nice_ceiling(double value) { return value_of(nice_at_least(value)); }

double round_ceiling(double value) {
  return value_of(least_not_below(value, {10, 12, 15, 20, 25, 30, 40, 50, 60, 80}));
}

std::string three_digits(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return "–";
  const std::string text = fmt::format("{:.2e}", std::abs(value));
  const int exponent = std::atoi(text.c_str() + text.find('e') + 1);
  if (exponent < -4 || exponent >= 7) {
    const std::string digits{text[0], text[2], text[3]};
    return with_minus(value < 0, with_exponent(digits, exponent));
  }
  double rounded = 0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return with_minus(value < 0, fmt::format("{:.{}f}", rounded, std::max(0, 2 - exponent)));
}

}  // namespace pillarfield::viewer
