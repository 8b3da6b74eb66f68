#include "tests/kernels/hard_cases.h"

#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <limits>

#include "pillarfield/status.h"

namespace pillarfield::hard_cases {
namespace {

using oracle::Exact;
using Raw = std::array<double, 4>;
using Examples = std::vector<Example>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool is_single(Precision precision) { return precision == Precision::single_precision; }

double least_above_zero(Precision precision) {
  return is_single(precision) ? double{std::numeric_limits<float>::denorm_min()}
                              : std::numeric_limits<double>::denorm_min();
}

double next_above(double value, Precision precision) {
  return is_single(precision) ? double{std::nextafter(static_cast<float>(value), INFINITY)}
                              : std::nextafter(value, kInfinity);
}

double next_below(double value, Precision precision) { return -next_above(-value, precision); }

/// A sensor of `k` counts per newton with one count of noise.
PillarSensor sensor_of(double k, double threshold_counts = 0) {
  PillarSensor sensor;
  sensor.counts_per_newton = k;
  sensor.threshold_counts = threshold_counts;
  sensor.noise_counts = 1;
  return sensor;
}

/// Adds the four quarter turns of a pillar.
void add_turns(Examples& examples, const Raw& raw, const PillarSensor& sensor) {
  for (std::size_t turn = 0; turn < 4; ++turn) {
    Example example{{}, sensor};
    for (std::size_t n = 0; n < 4; ++n) example.raw[(n + turn) % 4] = raw[n];
    examples.push_back(example);
  }
}

Examples turns_of(const std::vector<Raw>& pillars, const PillarSensor& sensor = sensor_of(1)) {
  Examples examples;
  for (const Raw& raw : pillars) add_turns(examples, raw, sensor);
  return examples;
}

/// Readings of a force from (theta, phi), zero where V is negative.
Example pressed(double force_n, Exact theta, Exact phi, double k, Precision precision) {
  Example example{{}, sensor_of(k)};
  const oracle::Readings readings = oracle::readings_from(force_n, theta, phi, k);
  for (std::size_t n = 0; n < 4; ++n) {
    example.raw[n] = readings[n] > 0 ? rounded(readings[n], precision) : 0.0;
  }
  return example;
}

Examples exactly_normal(Precision precision) {
  Examples examples;
  for (const double reading : {1.0, 60.0, 255.0, 1e-3, 1e6, 1.0 / 3}) {
    const double v = rounded(reading, precision);
    examples.push_back({{v, v, v, v}, sensor_of(320)});
  }
  return examples;
}

Examples nearly_normal(double theta, Precision precision) {
  Examples examples;
  for (int i = -16; i < 16; ++i) {
    examples.push_back(pressed(60, theta, (i + Exact(3) / 10) * exact::pi() / 16, 1, precision));
  }
  return examples;
}

/// phi at the axes (first = 0) or at the diagonals (first = 1), over the whole circle.
Examples at_quarters(int first, std::initializer_list<double> thetas, Precision precision) {
  Examples examples;
  for (const double theta : thetas) {
    for (int i = first - 4; i <= 4; i += 2) {
      examples.push_back(pressed(60, theta, i * exact::pi() / 4, 1, precision));
    }
  }
  return examples;
}

Examples in_region_1(int first, Precision precision) {
  return at_quarters(first, {0.1, 0.4, 0.7}, precision);
}

Examples beyond_region_1(int first, Precision precision) {
  return at_quarters(first, {1.0, 1.3, 1.5}, precision);
}

/// `pillar(threshold, reading)` with the reading at the threshold and one ULP to both sides of it,
/// for the thresholds 0 and 10.
template <class Pillar>
Examples about_threshold(Precision precision, Pillar pillar) {
  Examples examples;
  for (const double threshold : {0.0, 10.0}) {
    for (const double reading :
         {next_below(threshold, precision), threshold, next_above(threshold, precision)}) {
      add_turns(examples, pillar(threshold, reading), sensor_of(1, threshold));
    }
  }
  return examples;
}

Examples border_of_1_and_2(Precision precision) {
  return about_threshold(precision, [](double threshold, double reading) -> Raw {
    return {50, 100 - threshold, 50, reading};
  });
}

Examples border_of_2_and_3(Precision precision) {
  return about_threshold(precision, [](double, double reading) -> Raw {
    return {70, 90, reading, 0};
  });
}

Examples border_of_3_and_4(Precision precision) {
  return about_threshold(precision, [](double, double reading) -> Raw {
    return {70, reading, 0, 0};
  });
}

Examples border_of_contact(Precision precision) {
  return about_threshold(precision, [](double, double reading) -> Raw {
    return {reading, 0, 0, 0};
  });
}

Examples region_3(double ratio, Precision precision) {
  Examples examples;
  for (const double weaker : {1.0, 0.3, 47.0}) {
    const double weak = rounded(weaker, precision);
    const double strong = rounded(Exact(weak) * ratio, precision);
    add_turns(examples, {strong, weak, 0, 0}, sensor_of(320));
    add_turns(examples, {weak, strong, 0, 0}, sensor_of(320));
  }
  return examples;
}

/// Forces of one magnitude from all regions, for sensors of little and of great sensitivity.
Examples of_magnitude(double force_n, Precision precision) {
  Examples examples;
  for (const double k : {kMinCountsPerNewton, 1.0, 320.0}) {
    for (const double theta : {0.3, 0.8, 1.1, 1.4}) {
      for (int i = 0; i < 5; ++i) {
        examples.push_back(pressed(force_n, theta, Exact(1 + 3 * i) / 2, k, precision));
      }
    }
  }
  return examples;
}

Examples subnormal(Precision precision) {
  const double least = least_above_zero(precision);
  Examples examples;
  // Seven eighths of a reading of 8 need no rounding, whose error would be in counts, not newtons.
  for (const double k : {kMinCountsPerNewton, 1.0, 320.0}) {
    for (const Raw& raw : {Raw{7, 5, 3, 5}, Raw{1, 1, 1, 1}, Raw{60, 90, 31, 0}, Raw{9, 8, 0, 0},
                           Raw{1, 0, 0, 0}, Raw{100, 0, 3, 0}}) {
      const Raw scaled = {raw[0] * least, raw[1] * least, raw[2] * least, raw[3] * least};
      add_turns(examples, scaled, sensor_of(k));
    }
    add_turns(examples, {1, least, 0, 0}, sensor_of(k));
    add_turns(examples, {1, 1, least, 0}, sensor_of(k));
  }
  return examples;
}

Examples largest_readings(Precision precision) {
  const double most = rounded(kMaxCounts, precision);
  return turns_of({{most, most, most, most},
                   {most, most, most, 0},
                   {most, most, 0, 0},
                   {most, 0, 0, 0},
                   {most, 1, 0, 0},
                   {most, 0, most, 0}},
                  sensor_of(kMinCountsPerNewton));
}

Examples saturated(Precision) {
  PillarSensor sensor = sensor_of(1);
  sensor.full_scale_counts = 255;
  return turns_of({{255, 180, 20, 140},
                   {255, 250, 145, 240},
                   {255, 255, 60, 60},
                   {255, 100, 255, 120},
                   {255, 100, 0, 0},
                   {255, 0, 0, 0},
                   {255, 255, 255, 255}},
                  sensor);
}

/// Every way to put `odd` in the place of one reading or more, in every region.
Examples with_readings_of(double odd) {
  Examples examples;
  for (const Raw& raw :
       {Raw{50, 90, 50, 10}, Raw{50, 90, 40, 0}, Raw{70, 90, 0, 0}, Raw{70, 0, 0, 0}}) {
    for (unsigned places = 1; places < 16; ++places) {
      Example example{raw, sensor_of(1)};
      for (std::size_t n = 0; n < 4; ++n) {
        if ((places >> n & 1U) != 0) example.raw[n] = odd;
      }
      examples.push_back(example);
    }
  }
  return examples;
}

/// Forces that load all four sensels, one of which in turn is uninformative.
Examples one_missing(Precision precision) {
  Examples examples;
  for (const double theta : {1e-3, 0.3, 0.5}) {
    for (int i = -8; i < 8; ++i) {
      for (std::size_t missing = 0; missing < 4; ++missing) {
        examples.push_back(pressed(60, theta, i * exact::pi() / 8, 1, precision));
        examples.back().raw[missing] = kNan;
      }
    }
  }
  return examples;
}

Examples not_a_number(Precision) { return with_readings_of(kNan); }

Examples infinite(Precision) {
  Examples examples = with_readings_of(kInfinity);
  const Examples negative = with_readings_of(-kInfinity);
  examples.insert(examples.end(), negative.begin(), negative.end());
  return examples;
}

Examples negative(Precision precision) {
  const double least = least_above_zero(precision);
  const double most = rounded(kMaxCounts, precision);
  return turns_of({{50, 100, 50, -3},
                   {50, 100, 50, -least},
                   {70, 90, -1, -20},
                   {70, -most, -4, -2},
                   {-1, -2, -least, -most}});
}

Examples opposite(Precision precision) {
  return turns_of({{60, 0, 60, 0}, {60, 0, 1, 0}, {rounded(0.1, precision), 0, 200, 0}});
}

Examples one_sensel(Precision precision) {
  Examples examples = turns_of({{60, 0, 0, 0}, {rounded(0.1, precision), 0, 0, 0}});
  add_turns(examples, {60, 0, 0, 0}, sensor_of(320, 10));
  return examples;
}

Examples equal_readings(Precision) {
  return turns_of({{60, 60, 60, 0}, {60, 60, 0, 0}, {1, 1, 1, 0}, {1, 1, 0, 0}});
}

/// A case whose examples depend on a number.
template <class Make, class Number>
auto with(Number number, Make make) {
  return [=](Precision precision) { return make(number, precision); };
}

}  // namespace

const std::vector<HardCase>& hard_cases() {
  using status::kAmbiguous;
  using status::kInconsistent;
  using status::kSaturated;
  static const std::vector<HardCase> cases = {
      {"exactly_normal", "exactly normal", 0, exactly_normal},
      {"nearly_normal_1e_1", "nearly normal, θ = 1e-1", 0, with(1e-1, nearly_normal)},
      {"nearly_normal_1e_2", "nearly normal, θ = 1e-2", 0, with(1e-2, nearly_normal)},
      {"nearly_normal_1e_3", "nearly normal, θ = 1e-3", 0, with(1e-3, nearly_normal)},
      {"nearly_normal_1e_4", "nearly normal, θ = 1e-4", 0, with(1e-4, nearly_normal)},
      {"nearly_normal_1e_5", "nearly normal, θ = 1e-5", 0, with(1e-5, nearly_normal)},
      {"nearly_normal_1e_6", "nearly normal, θ = 1e-6", 0, with(1e-6, nearly_normal)},
      {"nearly_normal_1e_7", "nearly normal, θ = 1e-7", 0, with(1e-7, nearly_normal)},
      {"phi_along_axes_region_1", "φ a multiple of π/2, region 1", 0, with(0, in_region_1)},
      {"phi_along_diagonals_region_1", "φ an odd multiple of π/4, region 1", 0,
       with(1, in_region_1)},
      {"phi_along_diagonals_region_2", "φ an odd multiple of π/4, region 2", 0,
       with(1, beyond_region_1)},
      {"phi_along_axes_region_3", "φ a multiple of π/2, region 3", kAmbiguous,
       with(0, beyond_region_1)},
      {"equal_readings", "three or two readings, all equal", 0, equal_readings},
      {"border_of_regions_1_and_2", "threshold ± 1 ULP, regions 1 and 2", 0, border_of_1_and_2},
      {"border_of_regions_2_and_3", "threshold ± 1 ULP, regions 2 and 3", 0, border_of_2_and_3},
      {"border_of_regions_3_and_4", "threshold ± 1 ULP, regions 3 and 4", 0, border_of_3_and_4},
      {"border_of_contact", "threshold ± 1 ULP, region 4 and none", 0, border_of_contact},
      {"region_3_ratio_1", "region 3, R = 1", kAmbiguous, with(1.0, region_3)},
      {"region_3_ratio_2", "region 3, R = 2", kAmbiguous, with(2.0, region_3)},
      {"region_3_ratio_10", "region 3, R = 10", kAmbiguous, with(10.0, region_3)},
      {"region_3_ratio_1e3", "region 3, R = 1e3", kAmbiguous, with(1e3, region_3)},
      {"region_3_ratio_1e6", "region 3, R = 1e6", kAmbiguous, with(1e6, region_3)},
      {"one_sensel", "one sensel", 0, one_sensel},
      {"opposite_sensels", "two opposite sensels", kInconsistent, opposite},
      {"magnitude_1e_minus_30", "forces of 1e-30 N", 0, with(1e-30, of_magnitude)},
      {"magnitude_1e_minus_15", "forces of 1e-15 N", 0, with(1e-15, of_magnitude)},
      {"magnitude_1e15", "forces of 1e15 N", 0, with(1e15, of_magnitude)},
      {"magnitude_1e30", "forces of 1e30 N", 0, with(1e30, of_magnitude)},
      {"largest_readings", "readings of 1e33 counts, the largest", 0, largest_readings},
      {"subnormal_readings", "subnormal readings", 0, subnormal},
      {"saturated", "saturated sensels", kSaturated, saturated},
      {"negative_readings", "negative readings", 0, negative},
      {"one_missing", "region 1, one sensel missing", kInconsistent, one_missing},
      {"not_a_number", "readings that are not numbers", kInconsistent, not_a_number},
      {"infinite_readings", "infinite readings", kInconsistent, infinite},
  };
  return cases;
}

double rounded(Exact exact, Precision precision) {
  return is_single(precision) ? double{static_cast<float>(exact)} : static_cast<double>(exact);
}

}  // namespace pillarfield::hard_cases
