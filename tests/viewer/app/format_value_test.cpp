// Texts of values, uncertainties, directions and states.
#include "viewer/app/panels/format_value.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "pillarfield/status.h"

namespace pillarfield::viewer {
namespace {

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

PillarValues pillar(double x, double y, double normal, double sx, double sy, double sn) {
  PillarValues values;
  values.shear_x = static_cast<float>(x);
  values.shear_y = static_cast<float>(y);
  values.normal = static_cast<float>(normal);
  values.magnitude = static_cast<float>(std::hypot(x, y, normal));
  values.theta = static_cast<float>(std::atan2(std::hypot(x, y), normal));
  values.phi = static_cast<float>(std::atan2(-y, -x));
  values.status = status::kUsable;
  values.uncertainty.emplace();
  (*values.uncertainty)[0] = static_cast<float>(sx);
  (*values.uncertainty)[1] = static_cast<float>(sy);
  (*values.uncertainty)[2] = static_cast<float>(sn);
  return values;
}

double spread(const std::vector<double>& values) {
  double sum = 0;
  double squares = 0;
  for (const double value : values) {
    sum += value;
    squares += value * value;
  }
  const auto count = static_cast<double>(values.size());
  return std::sqrt(squares / count - sum * sum / count / count);
}

TEST(DirectionDeviation, IsTheSpreadOfForcesThatScatter) {
  std::mt19937 random(1);
  std::normal_distribution<double> scatter;
  for (const auto& [x, y, n] : {std::array{0.1, 0.05, 0.3}, {-0.2, 0.1, 0.05}, {0.01, -0.3, 0.1}}) {
    const double sx = 0.0004;
    const double sy = 0.0009;
    const double sn = 0.0006;
    std::vector<double> magnitudes;
    std::vector<double> thetas;
    std::vector<double> phis;
    const double phi = std::atan2(-y, -x);
    for (int i = 0; i < 20000; ++i) {
      const double a = x + sx * scatter(random);
      const double b = y + sy * scatter(random);
      const double c = n + sn * scatter(random);
      magnitudes.push_back(std::hypot(a, b, c));
      thetas.push_back(std::atan2(std::hypot(a, b), c));
      phis.push_back(std::remainder(std::atan2(-b, -a) - phi, 2 * std::numbers::pi));
    }
    const DirectionDeviation deviation = direction_deviation(pillar(x, y, n, sx, sy, sn));
    EXPECT_NEAR(deviation.magnitude / spread(magnitudes), 1, 0.03);
    EXPECT_NEAR(deviation.theta / spread(thetas), 1, 0.03);
    EXPECT_NEAR(deviation.phi / spread(phis), 1, 0.03);
  }
}

TEST(DirectionDeviation, IsNanWithoutDirection) {
  EXPECT_TRUE(std::isnan(direction_deviation(pillar(0, 0, 1, 0.1, 0.1, 0.1)).phi));
  EXPECT_TRUE(std::isnan(direction_deviation(pillar(0, 0, 0, 0.1, 0.1, 0.1)).magnitude));
  PillarValues unknown = pillar(1, 1, 1, 0, 0, 0);
  unknown.uncertainty.reset();
  EXPECT_TRUE(std::isnan(direction_deviation(unknown).theta));
}

TEST(FormatStatus, NameRegionAndFault) {
  EXPECT_EQ(format_status(0), "no contact");
  EXPECT_EQ(format_status(status::kUsable), "region 1");
  EXPECT_EQ(format_status(status::kSensel1 | status::kSensel2 | status::kAmbiguous),
            "region 3, ambiguous");
  EXPECT_EQ(format_status(status::kSensel1 | status::kSensel2 | status::kAmbiguous |
                          status::kFromNeighbours),
            "region 3, resolved from the contact");
  EXPECT_EQ(format_status(status::kUsable | status::kSaturated), "region 1, saturated");
  EXPECT_EQ(format_status(status::kSensel1 | status::kSensel3 | status::kInconsistent),
            "opposite sensels, inconsistent");
  EXPECT_EQ(format_status(status::kSaturated), "no usable sensel, saturated");
}

const Units kUnits;

TEST(Readout, HasTheDigitsThatItsDeviationAllows) {
  const auto words = [](double value, double deviation) {
    const ShownValue shown = kUnits.readout("F", Dimension::force, value, deviation);
    return shown.label + " " + shown.value + " " + with_unit(shown.range, shown.unit);
  };
  EXPECT_EQ(words(0.123456, 0.0056), "F 0.1235 ± 0.0056 N");
  EXPECT_EQ(words(-123.456, 2.3), "F −123.5 ± 2.3 N");
  EXPECT_EQ(words(-0.00001, 0.01), "F 0.000 ± 0.010 N");
  EXPECT_EQ(words(123.456, 230), "F 123 ± 230 N");
  EXPECT_EQ(words(0.123456, kNotANumber), "F 0.123  N");
  EXPECT_EQ(kUnits.readout("", Dimension::force, 1, 0).range, "");
}

TEST(Readout, AnIntervalDistinguishesItsEnds) {
  const auto range = [](double low, double high) {
    return kUnits.readout_between("", Dimension::force, low, low, high).range;
  };
  EXPECT_EQ(range(0.12, 0.34), "0.12 … 0.34");
  EXPECT_EQ(range(60, 73.3), "60 … 73");
  EXPECT_EQ(range(-5, -5), "−5.000 … −5.000");
  EXPECT_EQ(range(kNotANumber, 1), "");
}

TEST(Units, OfPressureScaleValuesAndNameThem) {
  const Units psi{kPressureUnits[1]};
  EXPECT_EQ(psi.title("Pressure", Dimension::pressure), "Pressure, psi");
  EXPECT_EQ(psi.text(Dimension::pressure, 6.894757293168), "1.00 psi");
  EXPECT_EQ(psi.readout("", Dimension::pressure, 68.94757293168, 6.894757293168).range, "± 1.0");
  EXPECT_EQ(psi.text(Dimension::angle, std::numbers::pi / 4), "45.0°");
  EXPECT_EQ(psi.plain(Dimension::length, 20), "20 mm");
  EXPECT_EQ(psi.fixed(Dimension::time, 0.25, 3), "0.250 s");
  EXPECT_EQ(psi.title("Region", Dimension::none), "Region");
}

TEST(ShownDirection, HasIntervalsWhereItIsAmbiguousAndDeviationsElsewhere) {
  PillarValues values = pillar(0.1, 0.05, 0.3, 0.004, 0.004, 0.003);
  EXPECT_TRUE(shown_direction(values, kUnits)[1].range.starts_with("± "));
  values.status = status::kSensel1 | status::kSensel2 | status::kAmbiguous;
  auto& planes = *values.uncertainty;
  const float pi = std::numbers::pi_v<float>;
  planes = {0.1f, 0.1f, 0.1f, pi / 4, pi / 3, 0.95f * pi, -0.95f * pi, 0.2f, 0.3f};
  const auto shown = shown_direction(values, kUnits);
  EXPECT_EQ(shown[0].range, "0.20 … 0.30");
  EXPECT_EQ(shown[1].range, "45 … 60");
  EXPECT_EQ(shown[2].range, "171 … 189");  // Counter-clockwise, past 180.
  EXPECT_EQ(shown[2].unit, "°");
}

TEST(FormatPlace, CountFromTheMiddleOfTheSkin) {
  ForceFieldView forces;
  forces.rows = 4;
  forces.cols = 6;
  EXPECT_EQ(format_place(forces, {0, 0}, 2, kUnits), "x −5.00, y 3.00 mm");
  EXPECT_EQ(format_place(forces, {3, 5}, 2, kUnits), "x 5.00, y −3.00 mm");
  EXPECT_EQ(format_pillar({3, 5}), "row 3, column 5");
}

TEST(FormatReadings, AreInTheOrderOfTheSensels) {
  PillarValues values;
  values.readings = {12, 34.5f, 0, 250};
  EXPECT_EQ(format_readings(values), "readings 1–4: 12  34.5  0  250  counts");
  values.has_pillars = false;
  EXPECT_EQ(format_readings(values), "reading: 12  counts");
}

ContactQuantities a_contact() {
  ContactQuantities contact;
  contact.pillars = 200;
  contact.normal_n = 50.123;
  contact.shear_x_n = -3;
  contact.shear_y_n = 4;
  contact.area_mm2 = 320;
  contact.peak_n = 0.4567;
  contact.mean_pressure_kpa = 156.6;
  return contact;
}

TEST(FormatQuantity, HasThreeDigitsAndNoWordThatClaimsNothing) {
  ContactQuantities contact = a_contact();
  const auto [kpa, psi, mmhg] = kPressureUnits;
  const auto text = [&](const char* name, const PressureUnit& unit = kPressureUnits.front()) {
    return format_quantity(quantity_column(name), contact, unit);
  };
  EXPECT_EQ(text("normal_n"), "50.1");
  EXPECT_EQ(text("shear_x_n"), "−3.00");
  EXPECT_EQ(text("mean_pressure_kpa"), "157");
  EXPECT_EQ(text("mean_pressure_kpa", psi), "22.7");
  EXPECT_EQ(text("friction"), "–");
  EXPECT_EQ(text("slip"), "–");
  EXPECT_EQ(text("time_to_slip_s"), "–");
  contact.friction = 0.6;
  contact.slip = SlipState::partial;
  contact.slip_forecast = {0.423, 0.31, std::nullopt, {0.004, 0.2, 0.97}};
  EXPECT_EQ(text("friction"), "0.600");
  EXPECT_EQ(text("slip"), "partial");
  EXPECT_EQ(text("time_to_slip_s"), "0.423");
  EXPECT_EQ(text("time_to_slip_high_s"), "–");
}

}  // namespace
}  // namespace pillarfield::viewer
