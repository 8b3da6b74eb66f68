#include "calibration/doctor/response_watch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace pillarfield {
namespace {

/// Load along the way around a sensel, relative to the neighbours on both sides, of one touch.
constexpr float kSameTouch = 0.2F;
/// Way of a touch's centre, in steps, from which it is at another place.
constexpr float kOtherPlace = 0.4F;
/// Largest response of a dead line.
constexpr double kDeadLine = 0.12;
constexpr std::size_t kLinePlaces = 3;

/// The ring around a sensel, in steps down and right modulo 2^64: opposite ones are four apart.
constexpr std::size_t kUp = ~std::size_t{0};
constexpr std::array<std::array<std::size_t, 2>, 8> kRing = {
    {{kUp, kUp}, {kUp, 0}, {kUp, 1}, {0, 1}, {1, 1}, {1, 0}, {1, kUp}, {0, kUp}}};

}  // namespace

ResponseWatch::ResponseWatch(std::uint32_t rows, std::uint32_t cols, std::uint32_t step)
    : rows_(rows), cols_(cols), step_(step), sensels_(std::size_t{rows} * cols) {
  for (std::vector<Between>& each : in_line_) each.resize(sensels_.size());
}

/// The signal at a place, 0 where it is no load; NaN where there is no good sensel.
float ResponseWatch::at(std::size_t row, std::size_t col) const {
  if (row >= rows_ || col >= cols_) return std::numeric_limits<float>::quiet_NaN();
  const std::size_t i = row * cols_ + col;
  return signals_[i] < least_[i] ? 0 : signals_[i];
}

void ResponseWatch::add(std::span<const float> signals, std::span<const float> least) {
  signals_ = signals;
  least_ = least;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (signals[i] > least[i]) sensels_[i].is_touched = true;
  }
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t col = 0; col < cols_; ++col) {
      if (!std::isnan(signals[row * cols_ + col])) test_sensel(row, col);
    }
  }
}

void ResponseWatch::test_sensel(std::size_t row, std::size_t col) {
  const float left = at(row, col - step_);
  const float right = at(row, col + step_);
  const float above = at(row - step_, col);
  const float below = at(row + step_, col);
  const std::size_t i = row * cols_ + col;
  if (left > 0 && right > 0) test_between(i, LineAxis::columns, left, right);
  if (above > 0 && below > 0) test_between(i, LineAxis::rows, above, below);
  if (!(left > 0 || right > 0 || above > 0 || below > 0)) return;
  std::array<float, 8> ring{};
  for (std::size_t n = 0; n < ring.size(); ++n) {
    ring.at(n) = at(row + kRing.at(n)[0] * step_, col + kRing.at(n)[1] * step_);
  }
  float expected = 0;
  for (std::size_t n = 0; n < 4; ++n) {
    if (!(ring.at(n) > 0 && ring.at(n + 4) > 0)) continue;
    const float weaker = std::min(ring.at(n), ring.at(n + 4));
    const auto is_way = [&](std::size_t first) {
      for (std::size_t k = 1; k < 4; ++k) {
        if (!(ring.at((first + k) % 8) > kSameTouch * weaker)) return false;
      }
      return true;
    };
    if (is_way(n) || is_way(n + 4)) expected = std::max(expected, weaker);
  }
  if (!(expected > least_[i])) return;
  Sums& sums = sensels_[i];
  sums.products += signals_[i] * expected;
  sums.squares += expected * expected;
  if (!sums.has_moved) note_place(sums, row, col);
}

void ResponseWatch::test_between(std::size_t sensel, LineAxis axis, float before, float behind) {
  const float weaker = std::min(before, behind);
  if (!(weaker > least_[sensel])) return;
  Between& between = in_line_.at(axis == LineAxis::columns ? 1 : 0)[sensel];
  between.products += signals_[sensel] * weaker;
  between.squares += weaker * weaker;
  (before > behind ? between.more_before : between.more_behind) = true;
}

/// Notes where the touch around a sensel has its centre, and when it has moved.
void ResponseWatch::note_place(Sums& sums, std::size_t row, std::size_t col) {
  float sum = 0;
  float down = 0;
  float across = 0;
  for (std::size_t y = row - 2 * step_; y != row + 2 * step_ + 1; ++y) {
    for (std::size_t x = col - 2 * step_; x != col + 2 * step_ + 1; ++x) {
      const float signal = at(y, x);
      if (!(signal > 0)) continue;
      sum += signal;
      down += signal * static_cast<float>(y);
      across += signal * static_cast<float>(x);
    }
  }
  if (!sums.is_tested) {
    sums.is_tested = true;
    sums.row = down / sum;
    sums.col = across / sum;
  }
  const float way = std::hypot(down / sum - sums.row, across / sum - sums.col);
  sums.has_moved = way > kOtherPlace * static_cast<float>(step_);
}

std::optional<double> ResponseWatch::response(std::size_t sensel) const {
  const Sums& sums = sensels_[sensel];
  if (!sums.has_moved) return std::nullopt;
  return double{sums.products} / sums.squares;
}

double ResponseWatch::deviation(std::size_t sensel, double noise) const {
  return noise / std::sqrt(double{sensels_[sensel].squares});
}

ResponseWatch::Line ResponseWatch::line(LineAxis axis, std::uint32_t number) const {
  const bool is_column = axis == LineAxis::columns;
  Line line;
  double squares = 0;
  for (std::size_t along = 0; along < (is_column ? rows_ : cols_); ++along) {
    const std::size_t i = is_column ? along * cols_ + number : number * cols_ + along;
    const Between& between = in_line_.at(is_column ? 1 : 0)[i];
    line.responds = line.responds || sensels_[i].is_touched;
    line.response += between.products;
    squares += between.squares;
    line.places += (between.more_before ? 1U : 0U) + (between.more_behind ? 1U : 0U);
  }
  if (squares > 0) line.response /= squares;
  return line;
}

std::vector<std::uint32_t> ResponseWatch::dead_lines(LineAxis axis) const {
  std::vector<std::uint32_t> dead;
  for (std::uint32_t n = 0; n < (axis == LineAxis::columns ? cols_ : rows_); ++n) {
    const Line found = line(axis, n);
    if (found.places >= kLinePlaces && found.response < kDeadLine && !found.responds)
      dead.push_back(n);
  }
  return dead;
}

double ResponseWatch::line_response(LineAxis axis, std::uint32_t number) const {
  return line(axis, number).response;
}

}  // namespace pillarfield
