#include "lab/studies/closed_form_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>

namespace pillarfield::contact_study {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

/// √v, 0 where v is negative.
double root(double v) { return v > 0 ? std::sqrt(v) : 0; }

/// acosh(size/r), 0 outside.
double cone_pressure(double r, double size) {
  return r < size ? std::acosh(size / std::max(r, 1e-12)) : 0;
}

/// Pressure of the paraboloid when its contact had the radius `size`: a superposition of flat
/// punches of radii t <= size, of strength (4/π) t √(1 − t²).
double paraboloid_pressure(double r2, double size) {
  const double inside = size * size - r2;
  if (inside <= 0) return 0;
  const double share = std::min(1.0, inside / (1 - r2));
  return 2 / std::numbers::pi *
         (std::sqrt(inside * (1 - size * size)) + (1 - r2) * std::asin(std::sqrt(share)));
}

double paraboloid_load(double size) {  // ∝ ∫₀^size t² √(1 − t²) dt
  const double s = size;
  return (std::asin(s) - s * std::sqrt(1 - s * s) * (1 - 2 * s * s)) / 8;
}

/// Size at which a contact bears a fraction of its load at size 1.
double size_at(double share, double (*load_of)(double size)) {
  double low = 0;
  double high = 1;
  for (int step = 0; step < 50; ++step) {
    const double middle = (low + high) / 2;
    (load_of(middle) < share * load_of(1) ? low : high) = middle;
  }
  return (low + high) / 2;
}

/// 1/√(1 − r²), at most 100.
double punch_pressure(double r2) { return r2 < 1 ? 1 / std::sqrt(std::max(1 - r2, 1e-4)) : 0; }

/// The squared pressures of two spheres.
std::array<double, 2> two_squares(const Body& body, double x, double y, double size) {
  const double half_distance = body.aspect * (1 + body.second) / 2;
  const auto square = [=](double centre, double radius) {
    const double dx = x - centre;
    return std::max(0.0, size * size * radius * radius - dx * dx - y * y);
  };
  return {square(-half_distance, 1), square(half_distance, body.second)};
}

double ripples(const Body& body, double x, double y) {
  if (body.shape != Shape::wavy) return 1;
  return 1 + body.ripple * std::cos(body.waves * x) * std::cos(body.waves * y);
}

/// Half the length of the contact along x at y.
double half_strip(const Body& body, double y) {
  switch (body.shape) {
    case Shape::cylinder:
      return std::abs(y) < body.aspect ? 1 : 0;
    case Shape::ellipse:
      return root(1 - y * y / (body.aspect * body.aspect));
    default:
      return root(1 - y * y);
  }
}

/// Reduction of full-sliding shear in the stick zone of a roller.
double rolled_pressure(const Body& body, double x, double y, double size) {
  const double shift = 1 - size;
  const double half = half_strip(body, y) - shift;
  if (half <= 0) return 0;
  return root(half * half - (x - shift) * (x - shift)) * ripples(body, x, y);
}

double angle_of(const Body& body) { return body.angle_deg * kDegree; }

/// Rotates from the body's frame to the skin's.
std::array<double, 2> turned(const Body& body, double x, double y) {
  const double c = std::cos(angle_of(body));
  const double s = std::sin(angle_of(body));
  return {c * x - s * y, s * x + c * y};
}

/// Unit vector of the shear on the skin, in the skin's frame.
std::array<double, 2> direction_at(const StudyContact& contact, double x, double y) {
  const TangentialLoad& tangential = contact.tangential;
  switch (tangential.motion) {
    case Motion::spin:
    case Motion::turn:
    case Motion::partial_turn: {
      const bool centred = tangential.motion == Motion::spin;
      const double from_x = x - (centred ? 0 : tangential.pivot_x);
      const double from_y = y - (centred ? 0 : tangential.pivot_y);
      const double far = std::max(std::hypot(from_x, from_y), 1e-12);
      return turned(contact.body, -from_y / far, from_x / far);
    }
    case Motion::roll:
      return turned(contact.body, 1, 0);
    default:
      return {std::cos(tangential.direction_deg * kDegree),
              std::sin(tangential.direction_deg * kDegree)};
  }
}

double shear_at(const StudyContact& contact, double x, double y, double pressure) {
  const Body& body = contact.body;
  const TangentialLoad& tangential = contact.tangential;
  switch (tangential.motion) {
    case Motion::press:
      return 0;
    case Motion::partial_slip:
    case Motion::partial_turn:
      return pressure - pressure_at(body, x, y, stick_size(body, tangential.load_ratio));
    case Motion::roll:
      return pressure - rolled_pressure(body, x, y, stick_size(body, tangential.load_ratio));
    default:
      return pressure;
  }
}

/// Half sizes of the contact's bounding box, radii.
double reach(const Body& body) {
  switch (body.shape) {
    case Shape::two_spheres:
    case Shape::merged_spheres:
      return body.aspect * (1 + body.second) / 2 + 1;
    case Shape::cylinder:
      return std::hypot(1, body.aspect);
    default:
      return 1;
  }
}

/// A square of skin, pitches.
struct Square {
  double left;
  double bottom;
  double side;
};

Traction operator+(const Traction& a, const Traction& b) {
  return {a.x + b.x, a.y + b.y, a.pressure + b.pressure};
}

Traction operator*(double factor, const Traction& a) {
  return {factor * a.x, factor * a.y, factor * a.pressure};
}

double difference(const Traction& a, const Traction& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.pressure - b.pressure)});
}

/// Integrates the tractions of a contact over squares.
class Cubature {
 public:
  explicit Cubature(const StudyContact& contact)
      : contact_(contact),
        cos_(std::cos(angle_of(contact.body))),
        sin_(std::sin(angle_of(contact.body))) {}

  [[nodiscard]] Traction over(const Square& square) const { return quarters(square, 0); }

 private:
  static constexpr int kDeepest = 6;
  static constexpr double kTolerance = 1e-5;

  [[nodiscard]] Traction at(double skin_x, double skin_y) const {
    const Body& body = contact_.body;
    const double dx = (skin_x - body.x) / body.radius;
    const double dy = (skin_y - body.y) / body.radius;
    return traction_at(contact_, cos_ * dx + sin_ * dy, cos_ * dy - sin_ * dx);
  }

  [[nodiscard]] Traction rule(const Square& square) const {
    constexpr std::array kPlaces = {0.069431844202973712, 0.330009478207571868,
                                    0.669990521792428132, 0.930568155797026288};
    constexpr std::array kWeights = {0.173927422568726929, 0.326072577431273071,
                                     0.326072577431273071, 0.173927422568726929};
    Traction sum;
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      for (std::size_t j = 0; j < kPlaces.size(); ++j) {
        sum = sum + kWeights[i] * kWeights[j] *
                        at(square.left + square.side * kPlaces[i],
                           square.bottom + square.side * kPlaces[j]);
      }
    }
    return square.side * square.side * sum;
  }

  [[nodiscard]] Traction quarters(const Square& square, int depth) const {
    const double half = square.side / 2;
    Traction sum;
    for (const double x : {square.left, square.left + half}) {
      for (const double y : {square.bottom, square.bottom + half}) {
        const Square quarter{x, y, half};
        sum = sum + refined(quarter, rule(quarter), depth + 1);
      }
    }
    return sum;
  }

  [[nodiscard]] Traction refined(const Square& square, const Traction& coarse, int depth) const {
    if (depth >= kDeepest) return coarse;
    const double half = square.side / 2;
    const std::array<Square, 4> parts = {Square{square.left, square.bottom, half},
                                         Square{square.left + half, square.bottom, half},
                                         Square{square.left, square.bottom + half, half},
                                         Square{square.left + half, square.bottom + half, half}};
    std::array<Traction, 4> rules;
    std::transform(parts.begin(), parts.end(), rules.begin(),
                   [&](const Square& part) { return rule(part); });
    const Traction fine = rules[0] + rules[1] + rules[2] + rules[3];
    if (difference(coarse, fine) < kTolerance) return fine;
    Traction sum;
    for (std::size_t i = 0; i < parts.size(); ++i) {
      sum = sum + refined(parts[i], rules[i], depth + 1);
    }
    return sum;
  }

  const StudyContact& contact_;
  double cos_;
  double sin_;
};

/// Scales the loads so that the largest normal force is `peak` counts.
void scale_to(PillarLoads& loads, double peak) {
  const double largest = *std::max_element(loads.normal.begin(), loads.normal.end());
  loads.counts_per_pressure = peak / largest;
  for (auto* plane : {&loads.shear_x, &loads.shear_y, &loads.normal}) {
    for (double& value : *plane) value *= loads.counts_per_pressure;
  }
}

}  // namespace

const char* name_of(Shape shape) {
  constexpr std::array kNames = {"sphere",         "ellipse", "paraboloid",   "two spheres",
                                 "merged spheres", "wavy",    "cylinder",     "cone",
                                 "truncated cone", "punch",   "rounded punch"};
  return kNames.at(static_cast<std::size_t>(shape));
}

const char* name_of(Motion motion) {
  constexpr std::array kNames = {"press", "partial slip", "slide", "spin",
                                 "turn",  "partial turn", "roll"};
  return kNames.at(static_cast<std::size_t>(motion));
}

const char* name_of(Family family) {
  constexpr std::array kNames = {"rounded", "cone", "punch"};
  return kNames.at(static_cast<std::size_t>(family));
}

Family family_of(Shape shape) {
  switch (shape) {
    case Shape::cone:
    case Shape::truncated_cone:
      return Family::cone;
    case Shape::punch:
    case Shape::rounded_punch:
      return Family::punch;
    default:
      return Family::rounded;
  }
}

bool slips(Motion motion) {
  return motion == Motion::slide || motion == Motion::spin || motion == Motion::turn;
}

double pressure_at(const Body& body, double x, double y, double size) {
  const double r2 = x * x + y * y;
  const double r = std::sqrt(r2);
  switch (body.shape) {
    case Shape::sphere:
    case Shape::wavy:
      return root(size * size - r2) * ripples(body, x, y);
    case Shape::ellipse:
      return root(size * size - x * x - y * y / (body.aspect * body.aspect));
    case Shape::paraboloid:
      return paraboloid_pressure(r2, size);
    case Shape::two_spheres: {
      const auto squares = two_squares(body, x, y, size);
      return std::sqrt(squares[0] + squares[1]);
    }
    case Shape::merged_spheres: {
      const auto squares = two_squares(body, x, y, size);
      return std::sqrt(std::max(squares[0], squares[1]));
    }
    case Shape::cylinder:
      return std::abs(y) < body.aspect ? root(size * size - x * x) : 0;
    case Shape::cone:
      return cone_pressure(r, size);
    case Shape::truncated_cone:
      return cone_pressure(r, size) - cone_pressure(r, body.second);
    case Shape::punch:
      return size < 1 ? root(size * size - r2) : punch_pressure(r2);
    case Shape::rounded_punch:
      break;
  }
  return root(size * size - r2) - root(body.second * body.second - r2);
}

double stick_size(const Body& body, double load_ratio) {
  const double left = 1 - load_ratio;
  switch (body.shape) {
    case Shape::paraboloid:
      return size_at(left, paraboloid_load);
    case Shape::cylinder:
    case Shape::cone:
      return std::sqrt(left);
    case Shape::truncated_cone:
      return std::sqrt(std::lerp(body.second * body.second, 1.0, left));
    case Shape::rounded_punch:
      return std::cbrt(std::lerp(std::pow(body.second, 3), 1.0, left));
    default:
      return std::cbrt(left);
  }
}

Traction traction_at(const StudyContact& contact, double x, double y) {
  const double pressure = pressure_at(contact.body, x, y);
  if (pressure <= 0) return {};
  const double shear = shear_at(contact, x, y, pressure);
  const auto direction = direction_at(contact, x, y);
  return {shear * direction[0], shear * direction[1], pressure};
}

PillarLoads loads_of(const StudyContact& contact) {
  constexpr int kMargin = 4;
  const int half = static_cast<int>(std::ceil(reach(contact.body) * contact.body.radius)) + kMargin;
  const Cubature cubature(contact);
  PillarLoads loads;
  loads.rows = static_cast<std::uint32_t>(2 * half);
  loads.cols = loads.rows;
  for (int row = 0; row < 2 * half; ++row) {
    for (int col = 0; col < 2 * half; ++col) {
      const Traction force =
          cubature.over({static_cast<double>(col - half), static_cast<double>(half - row - 1), 1});
      loads.shear_x.push_back(force.x);
      loads.shear_y.push_back(force.y);
      loads.normal.push_back(force.pressure);
    }
  }
  scale_to(loads, contact.peak_counts);
  return loads;
}

ForceField truth_of(const PillarLoads& loads, double friction, double counts_per_newton) {
  ForceField truth(loads.rows, loads.cols);
  for (std::size_t i = 0; i < truth.pillars(); ++i) {
    truth.shear_x[i] = static_cast<float>(friction * loads.shear_x[i] / counts_per_newton);
    truth.shear_y[i] = static_cast<float>(friction * loads.shear_y[i] / counts_per_newton);
    truth.normal[i] = static_cast<float>(loads.normal[i] / counts_per_newton);
  }
  return truth;
}

}  // namespace pillarfield::contact_study
