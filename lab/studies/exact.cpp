#include "lab/studies/exact.h"

#include <cmath>

namespace pillarfield::exact {
namespace {

/// x - x^3/3! + ... or, from first = 1, 1 - x^2/2! + ...: `power` is the first term's.
Exact alternating_series(Exact x, Exact first, int power) {
  Exact sum = first;
  Exact term = first;
  for (int n = power + 1; n < power + 120; n += 2) {
    term *= -x * x / (n * (n + 1));
    sum += term;
  }
  return sum;
}

Exact atan_of_inverse(int denominator) {
  Exact power = Exact(1) / denominator;
  Exact sum = power;
  for (int n = 3; n < 200; n += 2) {
    power /= -denominator * denominator;
    sum += power / n;
  }
  return sum;
}

Exact reduced(Exact x) {
  while (x > pi()) x -= 2 * pi();
  while (x < -pi()) x += 2 * pi();
  return x;
}

}  // namespace

Exact pi() {
  static const Exact value = 4 * (4 * atan_of_inverse(5) - atan_of_inverse(239));
  return value;
}

Exact sin(Exact x) {
  const Exact angle = reduced(x);
  return alternating_series(angle, angle, 1);
}

Exact cos(Exact x) { return alternating_series(reduced(x), 1, 0); }

Exact sqrt(Exact x) {
  if (x <= 0) return 0;
  Exact root = std::sqrt(static_cast<double>(x));
  for (int step = 0; step < 3; ++step) root = (root + x / root) / 2;
  return root;
}

Exact atan2(Exact y, Exact x) {
  // The first guess is a double's, whose range is less than what arguments may have.
  const Exact largest = abs(x) > abs(y) ? abs(x) : abs(y);
  x /= largest;
  y /= largest;
  const Exact radius = sqrt(x * x + y * y);
  Exact angle = std::atan2(static_cast<double>(y), static_cast<double>(x));
  for (int step = 0; step < 2; ++step) {
    // The sine of what is missing: its cube is below the last bit from the second step on.
    const Exact missing = (y * cos(angle) - x * sin(angle)) / radius;
    angle += missing + missing * missing * missing / 6;
  }
  return angle;
}

}  // namespace pillarfield::exact
