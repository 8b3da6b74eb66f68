#include "simulation/indenter/friction_contact.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pillarfield {
namespace {

/// Vector components of the cells that bear shear.
struct ShearVector {
  explicit ShearVector(std::size_t cells) : x(cells), y(cells) {}
  std::vector<double> x;
  std::vector<double> y;
};

double dot(const ShearVector& a, const ShearVector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.x.size(); ++i) sum += a.x[i] * b.x[i] + a.y[i] * b.y[i];
  return sum;
}

void add_scaled(const ShearVector& added, double factor, ShearVector& to) {
  for (std::size_t i = 0; i < to.x.size(); ++i) {
    to.x[i] += factor * added.x[i];
    to.y[i] += factor * added.y[i];
  }
}

double largest(const ShearVector& vectors) {
  double square = 0;
  for (std::size_t i = 0; i < vectors.x.size(); ++i) {
    square = std::max(square, vectors.x[i] * vectors.x[i] + vectors.y[i] * vectors.y[i]);
  }
  return std::sqrt(square);
}

/// Spectral projected gradients (Barzilai and Borwein's steps, exact line searches) on the cells
/// that may bear shear.
class ShearSearch {
 public:
  ShearSearch(const CellField& limit, HalfSpace& surface)
      : surface_(surface), plane_(limit.box), moved_(limit.box) {
    for (std::size_t i = 0; i < limit.values.size(); ++i) {
      if (!(limit.values[i] > 0)) continue;
      cells_.push_back(i);
      limit_.push_back(limit.values[i]);
    }
  }

  [[nodiscard]] ShearVector gather(const CellVectors& from) const {
    ShearVector gathered(cells_.size());
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      gathered.x[i] = from.x.values[cells_[i]];
      gathered.y[i] = from.y.values[cells_[i]];
    }
    return gathered;
  }

  void scatter(const ShearVector& from, CellVectors& to) const {
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      to.x.values[cells_[i]] = from.x[i];
      to.y.values[cells_[i]] = from.y[i];
    }
  }

  [[nodiscard]] ShearVector displaced(const ShearVector& shear) {
    scatter(shear, plane_);
    surface_.shear(plane_.x, plane_.y, moved_.x, moved_.y);
    return gather(moved_);
  }

  void project(ShearVector& shear) const {
    for (std::size_t i = 0; i < limit_.size(); ++i) {
      const double square = shear.x[i] * shear.x[i] + shear.y[i] * shear.y[i];
      if (square <= limit_[i] * limit_[i]) continue;
      const double factor = limit_[i] / std::sqrt(square);
      shear.x[i] *= factor;
      shear.y[i] *= factor;
    }
  }

  /// The number of iterations, or −1.
  int run(const ShearVector& drive, ShearVector& shear) {
    project(shear);
    ShearVector gradient = displaced(shear);
    add_scaled(drive, -1, gradient);
    const double tolerance_mm = kSlipTolerance * largest(drive);
    double length = 4 / surface_.most_shear_mm();
    for (int iteration = 0; iteration < kMostSlipIterations; ++iteration) {
      ShearVector direction = shear;
      add_scaled(gradient, -length, direction);
      project(direction);
      add_scaled(shear, -1, direction);
      if (largest(direction) <= tolerance_mm * length) return iteration;
      const ShearVector response = displaced(direction);
      const double curvature = dot(direction, response);
      if (!(curvature > 0)) return -1;
      const double step = std::min(1.0, -dot(gradient, direction) / curvature);
      add_scaled(direction, step, shear);
      add_scaled(response, step, gradient);
      length = iteration % 2 == 0 ? dot(direction, direction) / curvature
                                  : curvature / dot(response, response);
    }
    return -1;
  }

 private:
  HalfSpace& surface_;
  CellVectors plane_;
  CellVectors moved_;
  std::vector<std::size_t> cells_;
  std::vector<double> limit_;
};

}  // namespace

int solve_friction_contact(const CellField& limit, const CellVectors& drive_mm, HalfSpace& surface,
                           CellVectors& shear) {
  ShearSearch search(limit, surface);
  ShearVector found = search.gather(shear);
  const int iterations = search.run(search.gather(drive_mm), found);
  shear = CellVectors(limit.box);
  search.scatter(found, shear);
  return iterations;
}

}  // namespace pillarfield
