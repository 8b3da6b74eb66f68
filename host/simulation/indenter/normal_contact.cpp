#include "simulation/indenter/normal_contact.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pillarfield {
namespace {

/// Estimated sum of pressures at an approach, from the volume of overlap (H8).
double estimated_sum(const CellField& height_mm, double approach_mm, double cell_mm) {
  double overlap_mm = 0;
  double cells = 0;
  for (const double height : height_mm.values) {
    if (height >= approach_mm) continue;
    overlap_mm += approach_mm - height;
    ++cells;
  }
  if (cells == 0) return 0;
  return overlap_mm / (1.6 * std::numbers::pi * cell_mm * std::sqrt(cells / std::numbers::pi));
}

/// The approach at which the estimate is `sum`, by bisection.
double estimated_approach(const CellField& height_mm, double sum, double cell_mm) {
  double high = cell_mm * 1e-3;
  while (estimated_sum(height_mm, high, cell_mm) < sum) high *= 2;
  double low = 0;
  for (int i = 0; i < 12; ++i) {
    const double middle = (low + high) / 2;
    (estimated_sum(height_mm, middle, cell_mm) < sum ? low : high) = middle;
  }
  return high;
}

double smallest_cell_mm(const CellField& height_mm) {
  return *std::min_element(height_mm.values.begin(), height_mm.values.end());
}

/// The iteration on one window. Cells outside the indenter have no pressure.
class PressureSearch {
 public:
  PressureSearch(const CellField& height_mm, double sum, HalfSpace& surface)
      : height_(height_mm),
        sum_(sum),
        surface_(surface),
        pressure_(height_mm.box),
        depth_(height_mm.box),
        direction_(height_mm.box),
        response_(height_mm.box) {}

  /// Starts from a semi-ellipsoidal pressure over the overlap at `approach_mm`, exact for spheres.
  void start(double approach_mm) {
    for (std::size_t i = 0; i < height_.values.size(); ++i) {
      const double share = 1 - 2 * height_.values[i] / approach_mm;
      pressure_.values[i] = share > 0 ? std::sqrt(share) : 0;
    }
    scale_pressure();
    surface_.press(pressure_, depth_);
  }

  /// Iterates; true if it converged.
  bool run() {
    double previous = 1;
    bool conjugate = false;
    for (iterations_ = 0; iterations_ < kMostPressIterations; ++iterations_) {
      const double squares = find_gaps();
      if (is_balanced(squares)) return true;
      const double keep = conjugate ? squares / previous : 0;
      previous = squares;
      for (std::size_t i = 0; i < pressure_.values.size(); ++i) {
        double& direction = direction_.values[i];
        direction = pressure_.values[i] > 0 ? gap(i) + keep * direction : 0;
      }
      surface_.press(direction_, response_);
      conjugate = step(length_of_step());
    }
    return false;
  }

  [[nodiscard]] double approach_mm() const { return approach_; }
  [[nodiscard]] int iterations() const { return iterations_; }
  CellField take_pressure() { return std::move(pressure_); }

 private:
  [[nodiscard]] double gap(std::size_t i) const {
    return depth_.values[i] + height_.values[i] - approach_;
  }

  void scale_pressure() {
    double sum = 0;
    for (const double p : pressure_.values) sum += p;
    scale_ = sum_ / sum;
    for (double& p : pressure_.values) p *= scale_;
  }

  /// Sets the approach to its mean over the contact. Returns the sum of squared gaps.
  double find_gaps() {
    double mean = 0;
    cells_ = 0;
    for (std::size_t i = 0; i < pressure_.values.size(); ++i) {
      if (!(pressure_.values[i] > 0)) continue;
      mean += depth_.values[i] + height_.values[i];
      ++cells_;
    }
    approach_ = mean / static_cast<double>(cells_);
    double squares = 0;
    worst_overlap_ = 0;
    for (std::size_t i = 0; i < pressure_.values.size(); ++i) {
      if (pressure_.values[i] > 0) {
        squares += gap(i) * gap(i);
      } else {
        worst_overlap_ = std::max(worst_overlap_, -gap(i));
      }
    }
    return squares;
  }

  [[nodiscard]] double allowed_overlap() const { return 3 * kGapTolerance * approach_; }

  [[nodiscard]] bool is_balanced(double squares) const {
    return std::sqrt(squares / static_cast<double>(cells_)) <= kGapTolerance * approach_ &&
           worst_overlap_ <= allowed_overlap();
  }

  /// Step length to the minimum along the direction, with free approach.
  [[nodiscard]] double length_of_step() const {
    double mean = 0;
    for (std::size_t i = 0; i < pressure_.values.size(); ++i) {
      if (pressure_.values[i] > 0) mean += response_.values[i];
    }
    mean /= static_cast<double>(cells_);
    double slope = 0;
    double curvature = 0;
    for (std::size_t i = 0; i < pressure_.values.size(); ++i) {
      if (!(pressure_.values[i] > 0)) continue;
      slope += gap(i) * direction_.values[i];
      curvature += (response_.values[i] - mean) * direction_.values[i];
    }
    return curvature > 0 ? slope / curvature : 0;
  }

  /// Makes the step, drops tensile cells and adds overlapping ones. Returns whether none was added.
  bool step(double length) {
    bool added = false;
    bool dropped = false;
    for (std::size_t i = 0; i < pressure_.values.size(); ++i) {
      double& p = pressure_.values[i];
      if (p > 0) {
        p -= length * direction_.values[i];
        dropped |= p <= 0;
        p = std::max(p, 0.0);
      } else if (gap(i) < -allowed_overlap()) {
        p = -length * gap(i);
        added = true;
      }
    }
    scale_pressure();
    if (added || dropped) {
      surface_.press(pressure_, depth_);
    } else {
      for (std::size_t i = 0; i < depth_.values.size(); ++i) {
        depth_.values[i] = scale_ * (depth_.values[i] - length * response_.values[i]);
      }
    }
    return !added;
  }

  const CellField& height_;
  double sum_;
  HalfSpace& surface_;
  CellField pressure_;
  CellField depth_;      ///< displacement by the pressure
  CellField direction_;  ///< search direction
  CellField response_;   ///< displacement by direction_
  double approach_ = 0;
  double scale_ = 1;
  double worst_overlap_ = 0;
  std::size_t cells_ = 0;
  int iterations_ = 0;
};

CellBox reached(const CellField& height_mm, double approach_mm) {
  return box_where(height_mm, [=](double height) { return height < approach_mm; });
}

}  // namespace

std::optional<NormalContact> solve_normal_contact(const CellField& height_mm, double sum,
                                                  HalfSpaces& surfaces) {
  const double lowest = smallest_cell_mm(height_mm);
  if (!std::isfinite(lowest)) return std::nullopt;
  const double cell_mm = surfaces.cell_mm();
  CellField height = height_mm;
  for (double& value : height.values) value -= lowest;
  // Pressure moves the surface inwards, so only cells below the approach can touch. Too small a
  // window makes the approach too large, so the second window is large enough.
  double approach = estimated_approach(height, sum, cell_mm);
  NormalContact contact;
  CellBox window = reached(height, 1.05 * approach);
  while (true) {
    const CellField within = on_box(height, window);
    PressureSearch search(within, sum, surfaces.for_box(window));
    search.start(approach);
    if (!search.run()) return std::nullopt;
    contact.iterations += search.iterations();
    approach = search.approach_mm();
    const CellBox needed = reached(height, approach);
    if (window.holds(needed)) {
      contact.pressure = search.take_pressure();
      break;
    }
    window = hull(window, needed);
  }
  contact.approach_mm = approach + lowest;
  contact.contact = box_where(contact.pressure, [](double p) { return p > 0; });
  return contact;
}

}  // namespace pillarfield
