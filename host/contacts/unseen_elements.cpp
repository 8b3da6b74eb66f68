#include "contacts/unseen_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "contacts/contact_measure.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"

namespace pillarfield {
namespace {

constexpr std::int64_t kMargin = 3;     // elements around a contact that may be filled in
constexpr double kLeastOfPeak = 0.02;   // that is filled in
constexpr double kCountedOfPeak = 0.1;  // from which on an element is under the contact
constexpr double kUnknownPart = 0.6;    // error of what no other place of the contact shows
constexpr double kDeviationFactor = 1;  // of the root mean square of few errors

bool is_unseen(std::uint8_t status) {
  constexpr int kAmbiguous = status::kAmbiguous | status::kFromNeighbours;
  if ((status & status::kInconsistent) == 0) return false;
  return (status & status::kLoaded) == 0 || (status & kAmbiguous) != 0;
}

using Cells = std::vector<std::size_t>;

/// A contact's forces on the grid around it, and how the elements there are seen.
class Surroundings {
 public:
  Surroundings(const ForceFieldView& forces, std::span<const ContactRun> runs)
      : forces_(forces), first_row_(runs.front().row), end_row_(runs.front().row + 1) {
    for (const ContactRun& run : runs) {
      first_row_ = std::min<std::int64_t>(first_row_, run.row);
      end_row_ = std::max<std::int64_t>(end_row_, run.row + 1);
      first_col_ = std::min<std::int64_t>(first_col_, run.first);
      end_col_ = std::max<std::int64_t>(end_col_, run.end);
    }
    first_row_ = std::max<std::int64_t>(first_row_ - kMargin, 0);
    first_col_ = std::max<std::int64_t>(first_col_ - kMargin, 0);
    end_row_ = std::min<std::int64_t>(end_row_ + kMargin, forces.rows);
    end_col_ = std::min<std::int64_t>(end_col_ + kMargin, forces.cols);
    cols_ = end_col_ - first_col_;
  }

  [[nodiscard]] bool may_have_unseen() const {
    std::uint64_t met = 0;
    for (std::int64_t row = first_row_; row < end_row_; ++row) {
      const std::uint8_t* at = forces_.status.data() + row * forces_.cols + first_col_;
      std::int64_t left = cols_;
      for (; left >= 8; left -= 8, at += 8) {
        std::uint64_t word = 0;
        std::memcpy(&word, at, sizeof word);
        met |= word;
      }
      for (; left > 0; --left) met |= *at++;
    }
    return (met & kEachByte * status::kInconsistent) != 0;
  }

  /// Reads the forces of the runs; returns the unseen cells.
  Cells read(std::span<const ContactRun> runs) {
    const auto cells = static_cast<std::size_t>((end_row_ - first_row_) * cols_);
    for (auto& plane : values) plane.assign(cells, 0);
    in_contact.assign(cells, 0);
    unseen.assign(cells, 0);
    for (const ContactRun& run : runs) {
      for (std::uint32_t col = run.first; col < run.end; ++col) {
        const std::size_t from = std::size_t{run.row} * forces_.cols + col;
        const std::size_t to = cell(run.row - first_row_, col - first_col_);
        in_contact[to] = 1;
        if (is_unseen(forces_.status[from])) continue;
        const std::array planes = {forces_.normal, forces_.shear_x, forces_.shear_y};
        for (std::size_t k = 0; k < 3; ++k) {
          values[k][to] =
              planes[k].empty() || !std::isfinite(planes[k][from]) ? 0 : planes[k][from];
        }
      }
    }
    Cells found;
    for (std::size_t at = 0; at < cells; ++at) {
      const std::size_t row = static_cast<std::size_t>(first_row_) + at / cols();
      const std::size_t col = static_cast<std::size_t>(first_col_) + at % cols();
      unseen[at] = is_unseen(forces_.status[row * forces_.cols + col]) ? 1 : 0;
      if (unseen[at] != 0) found.push_back(at);
    }
    return found;
  }

  /// Sets the values of cells so that the field is as smooth as the others allow: the biharmonic
  /// equation, by relaxation. Normal forces stay at or above zero.
  void fill(const Cells& cells) {
    constexpr int kSweeps = 40;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k > 0 && forces_.shear_x.empty()) return;
      for (int sweep = 0; sweep < kSweeps; ++sweep) {
        for (const std::size_t at : cells) {
          const auto row = static_cast<std::int64_t>(at / cols());
          const auto col = static_cast<std::int64_t>(at % cols());
          const auto sum = [&](std::int64_t down, std::int64_t right) {
            return value(k, row + down, col + right) + value(k, row - down, col - right);
          };
          const double next =
              (8 * (sum(0, 1) + sum(1, 0)) - 2 * (sum(1, 1) + sum(1, -1)) - sum(0, 2) - sum(2, 0)) /
              20;
          values[k][at] = k == 0 ? std::max(next, 0.0) : next;
        }
      }
    }
  }

  /// Adds forces at a cell to a sum.
  void add(std::size_t at, const std::array<double, 3>& force, ContactSum& sum) const {
    const auto row = first_row_ + static_cast<std::int64_t>(at / cols());
    const auto col = first_col_ + static_cast<std::int64_t>(at % cols());
    const auto x = static_cast<double>(2 * col + 1 - forces_.cols);
    const auto y = static_cast<double>(forces_.rows - 2 * row - 1);
    sum.normal += force[0];
    sum.normal_x += force[0] * x;
    sum.normal_y += force[0] * y;
    sum.shear_x += force[1];
    sum.shear_x_y += force[1] * y;
    sum.shear_y += force[2];
    sum.shear_y_x += force[2] * x;
  }

  [[nodiscard]] std::array<double, 3> force_at(std::size_t at) const {
    return {values[0][at], values[1][at], values[2][at]};
  }

  /// Forces of an element of the contact that the sums hold, though it is unseen.
  [[nodiscard]] std::array<double, 3> counted_at(std::size_t at) const {
    if (in_contact[at] == 0) return {};
    const std::size_t place = (static_cast<std::size_t>(first_row_) + at / cols()) * forces_.cols +
                              static_cast<std::size_t>(first_col_) + at % cols();
    const auto of = [&](std::span<const float> plane) {
      return plane.empty() || !std::isfinite(plane[place]) ? 0.0 : plane[place];
    };
    return {of(forces_.normal), of(forces_.shear_x), of(forces_.shear_y)};
  }

  /// The cell `down` and `right` of another one, if the grid has it.
  [[nodiscard]] std::optional<std::size_t> beside(std::size_t at, std::int64_t down,
                                                  std::int64_t right) const {
    const auto row = static_cast<std::int64_t>(at / cols()) + down;
    const auto col = static_cast<std::int64_t>(at % cols()) + right;
    if (row < 0 || col < 0 || row >= end_row_ - first_row_ || col >= cols_) return std::nullopt;
    return cell(row, col);
  }

  /// True if the contact is seen on both sides of a cell, in its row or in its column.
  [[nodiscard]] bool is_enclosed(std::size_t at) const {
    const auto sees = [&](std::int64_t down, std::int64_t right) {
      for (auto next = beside(at, down, right); next; next = beside(*next, down, right)) {
        if (unseen[*next] == 0) return in_contact[*next] != 0;
      }
      return false;
    };
    return (sees(0, 1) && sees(0, -1)) || (sees(1, 0) && sees(-1, 0));
  }

  std::array<std::vector<double>, 3> values;  ///< normal, shear_x, shear_y
  std::vector<char> in_contact;
  std::vector<char> unseen;

 private:
  [[nodiscard]] std::size_t cols() const { return static_cast<std::size_t>(cols_); }
  [[nodiscard]] std::size_t cell(std::int64_t row, std::int64_t col) const {
    return static_cast<std::size_t>(row * cols_ + col);
  }

  /// Zero beyond the grid; beyond the skin what is at its edge.
  [[nodiscard]] double value(std::size_t k, std::int64_t row, std::int64_t col) const {
    row = std::clamp<std::int64_t>(row, -first_row_, forces_.rows - 1 - first_row_);
    col = std::clamp<std::int64_t>(col, -first_col_, forces_.cols - 1 - first_col_);
    if (row < 0 || col < 0 || row >= end_row_ - first_row_ || col >= cols_) return 0;
    return values[k][cell(row, col)];
  }

  const ForceFieldView& forces_;
  std::int64_t first_row_;
  std::int64_t end_row_;
  std::int64_t first_col_ = std::numeric_limits<std::int64_t>::max();
  std::int64_t end_col_ = 0;
  std::int64_t cols_ = 0;
};

std::array<double, 3> scaled(const std::array<double, 3>& force, double factor) {
  return {factor * force[0], factor * force[1], factor * force[2]};
}

/// The errors of filling in cells that are seen: the unseen ones, shifted over the contact. None
/// where less than half of them would lie in the contact.
std::optional<ContactSum> shifted_error(Surroundings field, const Cells& unseen, const Cells& under,
                                        std::int64_t down, std::int64_t right) {
  Cells hidden;
  std::size_t inside = 0;
  double filled = 0;
  double known = 0;
  std::vector<std::array<double, 3>> truth;
  for (const std::size_t at : under) {
    const auto to = field.beside(at, down, right);
    if (!to || field.unseen[*to] != 0) return std::nullopt;
    hidden.push_back(*to);
    inside += field.in_contact[*to] != 0 ? 1U : 0U;
    filled += field.values[0][at];
    known += field.values[0][*to];
    truth.push_back(field.force_at(*to));
  }
  if (2 * inside < under.size() || !(known > 0)) return std::nullopt;
  Cells all = unseen;
  all.insert(all.end(), hidden.begin(), hidden.end());
  field.fill(all);
  const double factor = std::min(filled / known, 3.0);
  ContactSum error;
  for (std::size_t i = 0; i < under.size(); ++i) {
    const auto found = field.force_at(hidden[i]);
    field.add(
        under[i],
        scaled({truth[i][0] - found[0], truth[i][1] - found[1], truth[i][2] - found[2]}, factor),
        error);
  }
  return error;
}

}  // namespace

std::vector<UnseenElements> unseen_elements(const ForceFieldView& forces,
                                            std::span<const ContactRun> runs) {
  if (runs.empty()) return {};
  Surroundings field(forces, runs);
  if (!field.may_have_unseen()) return {};
  const Cells unseen = field.read(runs);
  if (unseen.empty()) return {};
  field.fill(unseen);
  const double peak = *std::ranges::max_element(field.values[0]);
  std::vector<UnseenElements> found(2);
  Cells under;
  ContactSum all;
  ContactSum open;
  for (const std::size_t at : unseen) {
    if (!(field.values[0][at] > kLeastOfPeak * peak)) {
      field.add(at, scaled(field.counted_at(at), -1), found[0].fill);
      continue;
    }
    under.push_back(at);
    const bool counts = field.in_contact[at] == 0 && field.values[0][at] > kCountedOfPeak * peak;
    found[0].elements += counts ? 1 : 0;
    const auto force = field.force_at(at);
    field.add(at, force, found[0].fill);
    field.add(at, scaled(field.counted_at(at), -1), found[0].fill);
    field.add(at, scaled(force, kUnknownPart), all);
    if (!field.is_enclosed(at)) field.add(at, scaled(force, kUnknownPart), open);
  }
  constexpr std::array<std::array<std::int64_t, 2>, 4> kSides = {
      {{0, 1}, {0, -1}, {1, 0}, {-1, 0}}};
  constexpr std::int64_t kFarthest = 6;
  for (const auto& [down, right] : kSides) {
    for (std::int64_t far = 2; far <= kFarthest && !under.empty(); ++far) {
      const auto error = shifted_error(field, unseen, under, far * down, far * right);
      if (!error) continue;
      found[0].errors.push_back(*error);
      break;
    }
  }
  if (found[0].errors.empty()) found[0].errors.push_back(all);
  found[1].errors.push_back(open);
  return found;
}

ContactQuantities quantities_of(ContactSum seen, std::span<const UnseenElements> unseen,
                                const Pitch& pitch_mm, bool has_shear) {
  std::int64_t elements = 0;
  for (const UnseenElements& each : unseen) {
    seen.add(each.fill);
    elements += each.elements;
  }
  ContactQuantities of = quantities_of(seen, pitch_mm, has_shear);
  if (unseen.empty() || seen.pillars == 0) return of;
  const auto all = static_cast<double>(seen.pillars + elements);
  of.unseen = static_cast<double>(elements) / all;
  of.area_mm2 = all * pitch_mm.area_mm2();
  of.mean_pressure_kpa = 1000 * of.normal_n / of.area_mm2;
  std::array<double, 6> squares{};
  for (const UnseenElements& each : unseen) {
    for (const ContactSum& error : each.errors) {
      ContactSum other = seen;
      other.add(error);
      const ContactQuantities off = quantities_of(other, pitch_mm, has_shear);
      const std::array differences = {off.normal_n - of.normal_n,
                                      off.shear_x_n - of.shear_x_n,
                                      off.shear_y_n - of.shear_y_n,
                                      off.centre_of_pressure.x_mm - of.centre_of_pressure.x_mm,
                                      off.centre_of_pressure.y_mm - of.centre_of_pressure.y_mm,
                                      off.torque_nmm - of.torque_nmm};
      for (std::size_t k = 0; k < squares.size(); ++k) {
        squares[k] += differences[k] * differences[k] / static_cast<double>(each.errors.size());
      }
    }
  }
  for (double& square : squares) square = kDeviationFactor * std::sqrt(square);
  of.unseen_deviations = {squares[1], squares[2], squares[0], {squares[3], squares[4]}, squares[5]};
  return of;
}

}  // namespace pillarfield
