#include "contacts/unseen_elements.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include "contacts/contact_measure.h"
#include "pillarfield/status.h"
#include "skin/status_word.h"
#include "skin/vectors.h"

namespace pillarfield {
namespace {

constexpr std::int64_t kReach = 3;     // elements beside a contact that may be under it
constexpr std::int64_t kFarthest = 6;  // shift to places that are seen
constexpr std::int64_t kMargin = kReach + kFarthest + 2;
constexpr double kLeastOfPeak = 0.02;   // that is filled in
constexpr double kCountedOfPeak = 0.1;  // from which on an element is under the contact
constexpr double kUnknownPart = 0.6;    // error of what no other place of the contact shows

using Cells = std::vector<std::size_t>;
using Forces = std::array<double, 3>;  // normal, shear_x, shear_y

bool is_unseen(std::uint8_t status) {
  constexpr int kAmbiguous = status::kAmbiguous | status::kFromNeighbours;
  if ((status & status::kInconsistent) == 0) return false;
  return (status & status::kLoaded) == 0 || (status & kAmbiguous) != 0;
}

/// The least rectangle of elements around runs, enlarged.
struct Box {
  Box(std::span<const ContactRun> runs, std::int64_t margin) {
    for (const ContactRun& run : runs) {
      first_col = std::min<std::int64_t>(first_col, run.first - margin);
      end_col = std::max<std::int64_t>(end_col, run.end + margin);
    }
    first_row = runs.front().row - margin;
    end_row = runs.back().row + margin + 1;
  }
  [[nodiscard]] bool has(std::int64_t row, std::int64_t col) const {
    return row >= first_row && row < end_row && col >= first_col && col < end_col;
  }
  std::int64_t first_row = 0;
  std::int64_t end_row = 0;
  std::int64_t first_col = std::numeric_limits<std::int64_t>::max();
  std::int64_t end_col = std::numeric_limits<std::int64_t>::min();
};

/// True if a status byte in the box is that of a missing sensel, or one close behind its rows is.
bool may_have_unseen(const ForceFieldView& forces, const Box& box) {
  const std::span<const std::uint8_t> status = forces.status;
  if (status.size() < kWordBytes) return true;
  const auto first = static_cast<std::size_t>(std::max<std::int64_t>(box.first_col, 0));
  const auto end = static_cast<std::size_t>(std::min<std::int64_t>(box.end_col, forces.cols));
  const std::int64_t rows = std::min<std::int64_t>(box.end_row, forces.rows);
  std::uint64_t met = 0;
  for (std::int64_t row = std::max<std::int64_t>(box.first_row, 0); row < rows; ++row) {
    for (std::size_t col = first; col < end; col += kWordBytes) {
      const std::size_t at = static_cast<std::size_t>(row) * forces.cols + col;
      std::uint64_t word = 0;
      std::memcpy(&word, &status[std::min(at, status.size() - kWordBytes)], kWordBytes);
      met |= word;
    }
  }
  return (met & kEachByte * status::kInconsistent) != 0;
}

/// The forces of a contact on the grid around it, zero where others are.
struct Field {
  std::int64_t first_row = 0;
  std::int64_t first_col = 0;
  std::size_t cols = 0;
  double last_x = 0;  ///< places of the sums: half pitches from the middle
  double last_y = 0;
  std::vector<Forces> at;
  std::vector<std::size_t> source;  ///< the cell itself; beyond the skin the one at its edge
  std::vector<char> in_contact;
  std::vector<char> hidden;  ///< unseen, or beyond the skin

  [[nodiscard]] std::size_t moved(std::size_t cell, std::int64_t down, std::int64_t right) const {
    return cell + static_cast<std::size_t>(down) * cols + static_cast<std::size_t>(right);
  }
  [[nodiscard]] std::int64_t row_of(std::size_t cell) const {
    return first_row + static_cast<std::int64_t>(cell / cols);
  }
  [[nodiscard]] std::int64_t col_of(std::size_t cell) const {
    return first_col + static_cast<std::int64_t>(cell % cols);
  }

  /// Adds forces at a cell, times a factor, to a sum.
  void add(std::size_t cell, const Forces& force, double factor, ContactSum& sum) const {
    const double x = 2 * static_cast<double>(col_of(cell)) - last_x;
    const double y = last_y - 2 * static_cast<double>(row_of(cell));
    sum.normal += factor * force[0];
    sum.normal_x += factor * force[0] * x;
    sum.normal_y += factor * force[0] * y;
    sum.shear_x += factor * force[1];
    sum.shear_x_y += factor * force[1] * y;
    sum.shear_y += factor * force[2];
    sum.shear_y_x += factor * force[2] * x;
  }

  /// Sets cells so that the field is as smooth as the others allow: the biharmonic equation, by
  /// relaxation. Normal forces stay at or above zero.
  void fill(const Cells& cells) {
    for (int sweep = 0; sweep < 40; ++sweep) {
      for (const std::size_t cell : cells) {
        Forces next{};
        const auto take = [&](double weight, std::int64_t down, std::int64_t right) {
          const Forces& one = at[source[moved(cell, down, right)]];
          const Forces& other = at[source[moved(cell, -down, -right)]];
          for (std::size_t k = 0; k < 3; ++k) next[k] += weight * (one[k] + other[k]);
        };
        take(0.4, 0, 1);
        take(0.4, 1, 0);
        take(-0.1, 1, 1);
        take(-0.1, 1, -1);
        take(-0.05, 0, 2);
        take(-0.05, 2, 0);
        next[0] = std::max(next[0], 0.0);
        at[cell] = next;
      }
    }
  }

  /// True if the contact is seen on both sides of a cell, in its row or in its column.
  [[nodiscard]] bool is_enclosed(std::size_t cell) const {
    const auto sees = [&](std::int64_t down, std::int64_t right) {
      std::size_t next = moved(cell, down, right);
      while (hidden[next] != 0 && source[next] == next) next = moved(next, down, right);
      return hidden[next] == 0 && in_contact[next] != 0;
    };
    return (sees(0, 1) && sees(0, -1)) || (sees(1, 0) && sees(-1, 0));
  }
};

/// Reads a contact; lists its unseen cells, and takes what the sums hold of them out of `fill`.
Field read(const ForceFieldView& forces, std::span<const ContactRun> runs, Cells& unseen,
           ContactSum& fill) {
  const Box near(runs, kReach);
  const Box box(runs, kMargin);
  Field field;
  field.first_row = box.first_row;
  field.first_col = box.first_col;
  field.cols = static_cast<std::size_t>(box.end_col - box.first_col);
  field.last_x = forces.cols - 1.0;
  field.last_y = forces.rows - 1.0;
  const std::size_t cells = static_cast<std::size_t>(box.end_row - box.first_row) * field.cols;
  field.at.resize(cells);
  field.in_contact.resize(cells);
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::int64_t row = std::clamp<std::int64_t>(field.row_of(cell), 0, forces.rows - 1);
    const std::int64_t col = std::clamp<std::int64_t>(field.col_of(cell), 0, forces.cols - 1);
    field.source.push_back(field.moved(cell, row - field.row_of(cell), col - field.col_of(cell)));
    const auto element =
        static_cast<std::size_t>(row) * forces.cols + static_cast<std::size_t>(col);
    const bool missing = is_unseen(forces.status[element]);
    field.hidden.push_back(missing || field.source[cell] != cell ? 1 : 0);
    const bool is_own = field.source[cell] == cell && near.has(row, col);
    if (missing && is_own) unseen.push_back(cell);
  }
  for (const ContactRun& run : runs) {
    for (std::uint32_t col = run.first; col < run.end; ++col) {
      const std::size_t element = std::size_t{run.row} * forces.cols + col;
      const std::size_t cell = field.moved(0, run.row - box.first_row, col - box.first_col);
      const auto of = [&](std::span<const float> plane) {
        return plane.empty() ? 0.0 : finite_or_zero(plane[element]);
      };
      field.in_contact[cell] = 1;
      field.at[cell] = {of(forces.normal), of(forces.shear_x), of(forces.shear_y)};
      if (field.hidden[cell] != 0) field.add(cell, field.at[cell], -1, fill);
    }
  }
  return field;
}

/// The error of filling in cells that are seen: those under the contact, shifted. Unset where less
/// than half of them would lie in the contact, or one is unseen.
std::optional<ContactSum> shifted_error(Field field, const Cells& unseen, const Cells& under,
                                        std::int64_t down, std::int64_t right) {
  const Field truth = field;
  Cells all = unseen;
  std::size_t inside = 0;
  double filled = 0;
  double known = 0;
  for (const std::size_t cell : under) {
    const std::size_t to = field.moved(cell, down, right);
    if (field.hidden[to] != 0) return std::nullopt;
    all.push_back(to);
    inside += field.in_contact[to] != 0 ? 1U : 0U;
    filled += field.at[cell][0];
    known += field.at[to][0];
  }
  if (2 * inside < under.size() || !(known > 0)) return std::nullopt;
  field.fill(all);
  const double factor = std::min(filled / known, 3.0);
  ContactSum error;
  for (const std::size_t cell : under) {
    const std::size_t to = field.moved(cell, down, right);
    field.add(cell, truth.at[to], factor, error);
    field.add(cell, field.at[to], -factor, error);
  }
  return error;
}

}  // namespace

std::vector<UnseenElements> unseen_elements(const ForceFieldView& forces,
                                            std::span<const ContactRun> runs) {
  if (runs.empty() || !may_have_unseen(forces, Box(runs, kReach))) return {};
  std::vector<UnseenElements> found(2);
  Cells unseen;
  Field field = read(forces, runs, unseen, found[0].fill);
  if (unseen.empty()) return {};
  field.fill(unseen);
  double peak = 0;
  for (const Forces& force : field.at) peak = std::max(peak, force[0]);
  Cells under;
  ContactSum all;
  ContactSum open;
  for (const std::size_t cell : unseen) {
    const Forces& force = field.at[cell];
    if (!(force[0] > kLeastOfPeak * peak)) continue;
    under.push_back(cell);
    const bool counts = field.in_contact[cell] == 0 && force[0] > kCountedOfPeak * peak;
    found[0].elements += counts ? 1 : 0;
    field.add(cell, force, 1, found[0].fill);
    field.add(cell, force, kUnknownPart, field.is_enclosed(cell) ? all : open);
  }
  for (const std::array<std::int64_t, 2>& side :
       {std::array<std::int64_t, 2>{0, 1}, {0, -1}, {1, 0}, {-1, 0}}) {
    std::optional<ContactSum> error;
    for (std::int64_t far = 2; far <= kFarthest && !under.empty() && !error; ++far) {
      error = shifted_error(field, unseen, under, far * side[0], far * side[1]);
    }
    if (error) found[0].errors.push_back(*error);
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
  of.unseen_deviations.emplace();
  const auto values = [](const ContactQuantities& q) {
    return std::array{
        q.shear_x_n, q.shear_y_n, q.normal_n, q.centre_of_pressure.x_mm, q.centre_of_pressure.y_mm,
        q.torque_nmm};
  };
  std::array<double, 6> squares{};
  for (const UnseenElements& each : unseen) {
    for (const ContactSum& error : each.errors) {
      ContactSum other = seen;
      other.add(error);
      const auto off = values(quantities_of(other, pitch_mm, has_shear));
      for (std::size_t k = 0; k < off.size(); ++k) {
        const double difference = off[k] - values(of)[k];
        squares[k] += difference * difference / static_cast<double>(each.errors.size());
      }
    }
  }
  for (double& square : squares) square = std::sqrt(square);
  const auto [shear_x, shear_y, normal, x, y, torque] = squares;
  of.unseen_deviations = {shear_x, shear_y, normal, {x, y}, torque};
  return of;
}

}  // namespace pillarfield
