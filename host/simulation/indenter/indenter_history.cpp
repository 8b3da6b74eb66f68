#include "simulation/indenter/indenter_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield {
namespace {

/// A rotation about the skin's normal, counter-clockwise.
struct Turn {
  explicit Turn(double angle_deg)
      : cosine(std::cos(angle_deg * std::numbers::pi / 180)),
        sine(std::sin(angle_deg * std::numbers::pi / 180)) {}

  [[nodiscard]] PlaneVector undo(const PlaneVector& v) const {
    return {cosine * v.x + sine * v.y, cosine * v.y - sine * v.x};
  }

  double cosine;
  double sine;
};

/// Calls `visit(index, place)` for each cell of a box; `place` is its centre in the indenter's
/// frame.
template <class Visit>
void for_each_place(const CellGrid& grid, const CellBox& box, const IndenterKey& pose,
                    Visit visit) {
  const Turn turn(pose.angle_deg);
  std::size_t index = 0;
  for (std::int64_t row = box.first_row; row < box.end_row(); ++row) {
    for (std::int64_t col = box.first_col; col < box.end_col(); ++col, ++index) {
      visit(index, turn.undo({grid.x_mm(col) - pose.x_mm, grid.y_mm(row) - pose.y_mm}));
    }
  }
}

bool is_same_pose(const IndenterKey& a, const IndenterKey& b) {
  return a.x_mm == b.x_mm && a.y_mm == b.y_mm && a.angle_deg == b.angle_deg && a.load_n == b.load_n;
}

bool is_any_nonzero(const CellVectors& vectors) {
  const auto nonzero = [](double value) { return value != 0; };
  return std::ranges::any_of(vectors.x.values, nonzero) ||
         std::ranges::any_of(vectors.y.values, nonzero);
}

std::int64_t pillar_of(std::int64_t cell) {
  return (cell >= 0 ? cell : cell - (kCellsPerPillar - 1)) / kCellsPerPillar;
}

/// The sum of a traction over a pillar's cells, and its first moments about the pillar's axis, in
/// cells to the right and up.
struct TractionMoments {
  double sum = 0;
  double right = 0;
  double up = 0;
};

TractionMoments moments_over(const CellField& traction, const CellBox& pillar,
                             const CellBox& contact) {
  TractionMoments moments;
  if (traction.box.empty()) return moments;
  constexpr double kToAxis = static_cast<double>(kCellsPerPillar - 1) / 2;
  const CellBox cells = intersection(pillar, contact);
  for (std::int64_t row = cells.first_row; row < cells.end_row(); ++row) {
    for (std::int64_t col = cells.first_col; col < cells.end_col(); ++col) {
      const double value = traction.values[traction.index(row, col)];
      moments.sum += value;
      moments.right += value * (static_cast<double>(col - pillar.first_col) - kToAxis);
      moments.up += value * (kToAxis - static_cast<double>(row - pillar.first_row));
    }
  }
  return moments;
}

std::uint64_t last_frame_of(const Indenter& indenter, double rate_hz) {
  return static_cast<std::uint64_t>(std::ceil(indenter.path.back().time_s * rate_hz));
}

}  // namespace

IndenterHistory::IndenterHistory(const Scene& scene, std::size_t number)
    : indenter_(scene.indenters.at(number)),
      number_(number),
      rate_hz_(scene.rate_hz),
      last_frame_(last_frame_of(indenter_, scene.rate_hz)),
      pillar_rows_(scene.skin.element_rows()),
      pillar_cols_(scene.skin.element_cols()),
      grid_(scene.skin),
      traction_to_force_n_(grid_.cell_mm() * grid_.cell_mm() * std::numbers::pi * (4.0 / 3) *
                           scene.modulus_kpa * 1e-3),
      surface_(indenter_, scene.skin.element_pitch_mm().col_mm, scene.seed, number),
      half_spaces_(grid_.cell_mm()) {}

std::shared_ptr<const IndenterForces> IndenterHistory::forces(std::uint64_t frame) {
  frame = std::min(frame, last_frame_);
  // Solved frames are returned without waiting for the solver.
  if (SharedForces known = solved(frame)) return known;
  const std::scoped_lock solving(solving_mutex_);
  while (true) {
    if (SharedForces known = solved(frame)) return known;
    SharedForces next = next_frame();
    const std::scoped_lock lock(frames_mutex_);
    frames_.push_back(std::move(next));
  }
}

IndenterHistory::SharedForces IndenterHistory::solved(std::uint64_t frame) const {
  const std::scoped_lock lock(frames_mutex_);
  return frame < frames_.size() ? frames_[frame] : nullptr;
}

IndenterHistory::SharedForces IndenterHistory::next_frame() {
  const auto frame = static_cast<double>(frames_.size());
  if (frames_.empty()) {
    step_to(state_at(indenter_, 0));
    return forces_;
  }
  const std::uint32_t steps = indenter_.substeps;
  // On failure the state is that of the frame before, so a later call can retry.
  const auto before = std::make_tuple(pose_, shear_, touches_, forces_);
  try {
    for (std::uint32_t step = 1; step <= steps; ++step) {
      const double part = static_cast<double>(step) / steps;
      step_to(state_at(indenter_, (frame - 1 + part) / rate_hz_));
    }
  } catch (...) {
    std::tie(pose_, shear_, touches_, forces_) = before;
    throw;
  }
  return forces_;
}

void IndenterHistory::step_to(const IndenterKey& pose) {
  if (is_interrupted()) throw Error(place(pose), "interrupted", "start again");
  if (forces_ && is_same_pose(pose, pose_)) return;
  CellVectors shear;
  SharedForces forces;
  const bool touches = pose.load_n > 0;
  if (touches) {
    const NormalContact normal = press(pose);
    shear = rub(pose, normal);
    forces = std::make_shared<const IndenterForces>(on_pillars(normal, shear));
  } else {
    forces = std::make_shared<const IndenterForces>();
  }
  pose_ = pose;
  shear_ = std::move(shear);
  touches_ = touches;
  forces_ = std::move(forces);
}

NormalContact IndenterHistory::press(const IndenterKey& pose) {
  constexpr double kMostCells = kMaxContactPillars * kCellsPerPillar;
  const Turn turn(pose.angle_deg);
  const PlaneVector reach = surface_.reach_mm();
  const double cosine = std::abs(turn.cosine);
  const double sine = std::abs(turn.sine);
  const PlaneVector centre = {pose.x_mm, pose.y_mm};
  const double most_mm = (kMostCells / 2 - 1) * grid_.cell_mm();
  const PlaneVector turned = {cosine * reach.x + sine * reach.y, sine * reach.x + cosine * reach.y};
  const CellBox box =
      grid_.box_around(centre, {std::min(turned.x, most_mm), std::min(turned.y, most_mm)});
  CellField height(box);
  for_each_place(grid_, box, pose, [&](std::size_t index, const PlaneVector& at) {
    height.values[index] = surface_.height_mm(at.x, at.y);
  });
  if (std::ranges::none_of(height.values, [](double h) { return std::isfinite(h); })) {
    throw Error(
        place(pose),
        fmt::format("it lies between the cells of {:.4g} mm that bear the load", grid_.cell_mm()),
        "make the indenter larger than a cell");
  }
  std::optional<NormalContact> normal =
      solve_normal_contact(height, pose.load_n / traction_to_force_n_, half_spaces_);
  if (!normal) {
    throw Error(place(pose),
                fmt::format("its pressure was not found in {} iterations", kMostPressIterations),
                "change its shape or load");
  }
  // If the indenter extends beyond the box, the contact must end inside it.
  const CellBox inner = {box.first_row + 2, box.first_col + 2, box.rows - 4, box.cols - 4};
  if ((turned.x > most_mm || turned.y > most_mm) && !inner.holds(normal->contact)) {
    throw Error(place(pose),
                fmt::format("its contact is more than {} pillars wide", kMaxContactPillars),
                "lower its load or make it smaller");
  }
  return *std::move(normal);
}

CellVectors IndenterHistory::rub(const IndenterKey& pose, const NormalContact& normal) {
  const CellBox& contact = normal.contact;
  CellField limit = on_box(normal.pressure, contact);
  for_each_place(grid_, contact, pose, [&](std::size_t index, const PlaneVector& at) {
    limit.values[index] *= surface_.friction(at.x, at.y);
  });
  const CellVectors drive_mm = drive(pose, contact);
  const bool slips = std::ranges::any_of(limit.values, [](double value) { return value > 0; });
  if (!slips || !is_any_nonzero(drive_mm)) return {};
  CellVectors shear;
  shear.x = on_box(shear_.x, contact);
  shear.y = on_box(shear_.y, contact);
  if (solve_friction_contact(limit, drive_mm, half_spaces_.for_box(contact), shear) < 0) {
    throw Error(place(pose),
                fmt::format("its shear was not found in {} iterations", kMostSlipIterations),
                "take more substeps");
  }
  return shear;
}

/// Displacements of the contact's cells if none slipped: those under the earlier shear plus the
/// indenter's movement (H9).
CellVectors IndenterHistory::drive(const IndenterKey& pose, const CellBox& contact) {
  CellVectors drive_mm(contact);
  if (!touches_) return drive_mm;
  const double turn = (pose.angle_deg - pose_.angle_deg) * std::numbers::pi / 180;
  const double middle_x = (pose.x_mm + pose_.x_mm) / 2;
  const double middle_y = (pose.y_mm + pose_.y_mm) / 2;
  std::size_t index = 0;
  for (std::int64_t row = contact.first_row; row < contact.end_row(); ++row) {
    for (std::int64_t col = contact.first_col; col < contact.end_col(); ++col, ++index) {
      drive_mm.x.values[index] = pose.x_mm - pose_.x_mm - turn * (grid_.y_mm(row) - middle_y);
      drive_mm.y.values[index] = pose.y_mm - pose_.y_mm + turn * (grid_.x_mm(col) - middle_x);
    }
  }
  add_elastic_shear(drive_mm, pose);
  return drive_mm;
}

void IndenterHistory::add_elastic_shear(CellVectors& drive_mm, const IndenterKey& pose) {
  if (shear_.box().empty()) return;
  const CellBox both = hull(shear_.box(), drive_mm.box());
  constexpr std::int64_t kMostCells = std::int64_t{2} * kMaxContactPillars * kCellsPerPillar;
  if (both.rows > kMostCells || both.cols > kMostCells) {
    throw Error(place(pose),
                fmt::format("it moves {:.3g} mm in one step",
                            std::hypot(pose.x_mm - pose_.x_mm, pose.y_mm - pose_.y_mm)),
                "give it more substeps, or withdraw it in between");
  }
  CellVectors moved(both);
  half_spaces_.for_box(both).shear(on_box(shear_.x, both), on_box(shear_.y, both), moved.x,
                                   moved.y);
  const CellField x = on_box(moved.x, drive_mm.box());
  const CellField y = on_box(moved.y, drive_mm.box());
  for (std::size_t i = 0; i < x.values.size(); ++i) {
    drive_mm.x.values[i] += x.values[i];
    drive_mm.y.values[i] += y.values[i];
  }
}

IndenterForces IndenterHistory::on_pillars(const NormalContact& normal,
                                           const CellVectors& shear) const {
  const CellBox& contact = normal.contact;
  const CellBox pillars =
      intersection({pillar_of(contact.first_row), pillar_of(contact.first_col),
                    pillar_of(contact.end_row() - 1) - pillar_of(contact.first_row) + 1,
                    pillar_of(contact.end_col() - 1) - pillar_of(contact.first_col) + 1},
                   {0, 0, pillar_rows_, pillar_cols_});
  IndenterForces forces;
  forces.reserve(pillars.cells());
  for (std::int64_t row = pillars.first_row; row < pillars.end_row(); ++row) {
    for (std::int64_t col = pillars.first_col; col < pillars.end_col(); ++col) {
      const CellBox cells = {row * kCellsPerPillar, col * kCellsPerPillar, kCellsPerPillar,
                             kCellsPerPillar};
      const TractionMoments pressure = moments_over(normal.pressure, cells, contact);
      if (pressure.sum == 0) continue;
      const double to_n = traction_to_force_n_;
      const double to_n_mm = to_n * grid_.cell_mm();
      const auto pillar =
          static_cast<std::size_t>(row) * pillar_cols_ + static_cast<std::size_t>(col);
      forces.push_back({pillar, moments_over(shear.x, cells, contact).sum * to_n,
                        moments_over(shear.y, cells, contact).sum * to_n, pressure.sum * to_n,
                        pressure.right * to_n_mm, pressure.up * to_n_mm});
    }
  }
  return forces;
}

std::string IndenterHistory::place(const IndenterKey& pose) const {
  return fmt::format("indenter {} at {:.6g} s", number_ + 1, pose.time_s);
}

}  // namespace pillarfield
