#include "io/hdf5/contact_hdf5_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/contact_columns.h"
#include "io/force_format.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/file.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

/// Limit per frame, so that a damaged file causes an allocation of at most a few hundred megabytes.
constexpr std::uint64_t kMaxContacts = 1'000'000;

/// Indices into kPatchRows.
enum PatchRow : std::uint8_t { kFirstContact, kContactCount, kFirstEnded, kEndedCount };

/// Sets all columns of `rows`; `part` returns the member of a row that holds the columns.
template <class Row, class Item, class Part>
void read_columns(std::span<const ContactColumn<Row>> columns,
                  const std::optional<hdf5::StoredFrames>* datasets, std::uint64_t first,
                  std::vector<Item>& rows, Part part) {
  std::vector<double> values(rows.size());
  for (const auto& column : columns) {
    const auto& dataset = *datasets++;
    if (!dataset) continue;
    dataset->get_all(first, values.size(), H5T_NATIVE_DOUBLE, values.data());
    for (std::size_t i = 0; i < rows.size(); ++i) column.set(part(rows[i]), values[i]);
  }
}

}  // namespace

void ContactTablesReader::Table::open(const hdf5::File& file, const std::string& group,
                                      const char* name, bool optional) {
  const std::string path = group + "/" + name;
  columns.emplace_back();
  if (optional && !hdf5::exists(file, path)) return;
  columns.back().emplace(file, path, 0);
  const std::uint64_t frames = columns.back()->frames();
  rows = columns.size() == 1 ? frames : std::min(rows, frames);
}

ContactTablesReader::ContactTablesReader(const hdf5::File& file, SkinLayout layout)
    : path_(file.path) {
  options_.layout = layout;
  read_options(file);
  columns_ = quantity_columns(true, options_.layout);
  open_tables(file);
  if (file.unclosed) drop_frames_without_rows();
}

void ContactTablesReader::open_tables(const hdf5::File& file) {
  for (const auto& column : identity_columns())
    contacts_.open(file, force_format::kContacts, column.name);
  for (const auto& column : columns_)
    contacts_.open(file, force_format::kContacts, column.name, column.optional);
  for (const char* name : force_format::kPatchRows) patch_.open(file, force_format::kPatch, name);
  for (const auto& column : columns_)
    patch_.open(file, force_format::kPatch, column.name, column.optional);
  for (const auto& column : ended_columns()) ended_.open(file, force_format::kEnded, column.name);
  frames_ = patch_.rows;
}

/// Drops the last frames if they refer to absent rows, which a killed writer leaves. Rows are in
/// the order of frames.
void ContactTablesReader::drop_frames_without_rows() {
  std::uint64_t good = 0;
  for (std::uint64_t beyond = frames_ + 1; beyond - good > 1;) {
    const std::uint64_t middle = good + (beyond - good) / 2;
    (has_rows_of(middle - 1) ? good : beyond) = middle;
  }
  frames_ = good;
}

bool ContactTablesReader::has_rows_of(std::uint64_t index) const {
  return count_at(kFirstContact, index) + count_at(kContactCount, index) <= contacts_.rows &&
         count_at(kFirstEnded, index) + count_at(kEndedCount, index) <= ended_.rows;
}

void ContactTablesReader::read_options(const hdf5::File& file) {
  const hdf5::Handle group = hdf5::open_object(file, force_format::kContacts);
  const auto minimum = hdf5::read_number(file, group.get(), force_format::kMinimumPillars);
  constexpr double kMaxExact = 0x1p53;
  if (minimum && *minimum >= 0 && *minimum <= kMaxExact) {
    options_.minimum_pillars = static_cast<std::uint64_t>(*minimum);
  }
  options_.friction.given = hdf5::read_number(file, group.get(), force_format::kGivenFriction);
  options_.reach_mm =
      hdf5::read_number(file, group.get(), force_format::kReach).value_or(options_.reach_mm);
  check(options_, file.path.string());
}

std::uint64_t ContactTablesReader::count_at(std::size_t column, std::uint64_t index) const {
  std::uint64_t count = 0;
  patch_.columns[column]->get(index, H5T_NATIVE_UINT64, &count);
  // Clamped, so that the sum of two does not wrap.
  return std::min<std::uint64_t>(count, INT64_MAX);
}

void ContactTablesReader::require_rows(const Table& table, std::uint64_t first,
                                       std::uint64_t count) const {
  if (first + count <= table.rows) return;
  throw Error(path_.string(),
              fmt::format("has {} rows in {}, but a frame refers to row {}", table.rows,
                          table.columns.front()->name(), first + count - 1),
              hdf5::kDamaged);
}

FrameContacts ContactTablesReader::read(std::uint64_t index) const {
  const std::uint64_t first_contact = count_at(kFirstContact, index);
  const std::uint64_t contacts = count_at(kContactCount, index);
  const std::uint64_t first_ended = count_at(kFirstEnded, index);
  const std::uint64_t ended = count_at(kEndedCount, index);
  require_rows(contacts_, first_contact, contacts);
  require_rows(ended_, first_ended, ended);
  if (std::max(contacts, ended) > kMaxContacts) {
    throw Error(
        path_.string(),
        fmt::format("frame {} claims to have {} contacts", index, std::max(contacts, ended)),
        hdf5::kDamaged);
  }

  FrameContacts frame;
  frame.contacts.resize(contacts);
  frame.ended.resize(ended);
  const auto itself = [](auto& row) -> auto& { return row; };
  const auto quantities = [](TrackedContact& contact) -> ContactQuantities& {
    return contact.quantities;
  };
  const std::optional<hdf5::StoredFrames>* const contact_columns = contacts_.columns.data();
  read_columns(identity_columns(), contact_columns, first_contact, frame.contacts, itself);
  read_columns(columns_, contact_columns + identity_columns().size(), first_contact, frame.contacts,
               quantities);
  read_columns(ended_columns(), ended_.columns.data(), first_ended, frame.ended, itself);
  std::vector<ContactQuantities> patch(1);
  read_columns(columns_, patch_.columns.data() + std::size(force_format::kPatchRows), index, patch,
               itself);
  frame.total = patch[0];
  frame.total.has_shear = options_.layout == SkinLayout::pillars;
  for (TrackedContact& contact : frame.contacts) {
    contact.quantities.has_shear = frame.total.has_shear;
  }
  return frame;
}

}  // namespace pillarfield
