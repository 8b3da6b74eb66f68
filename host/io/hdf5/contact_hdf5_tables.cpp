#include "io/hdf5/contact_hdf5_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/force_format.h"
#include "io/hdf5/attribute.h"
#include "io/hdf5/stored_frames.h"
#include "pillarfield/contact_columns.h"
#include "pillarfield/error.h"

namespace pillarfield {
namespace {

hid_t stored_type(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::number:
      return H5T_IEEE_F64LE;
    case ColumnKind::word:
      return H5T_STD_U8LE;
    case ColumnKind::count:
    case ColumnKind::identity:
      break;
  }
  return H5T_STD_U64LE;
}

template <class Row>
void add_columns(const hdf5::File& file, std::span<const ContactColumn<Row>> columns,
                 Hdf5Table& table) {
  for (const auto& column : columns) {
    const bool is_word = column.kind == ColumnKind::word;
    table.add_column(file, column.name, stored_type(column.kind), column.unit,
                     is_word ? words_of(column) : "");
  }
}

template <class Row>
void put_row(std::span<const ContactColumn<Row>> columns, const Row& row, Hdf5Table& table) {
  for (const auto& column : columns) table.put(column.get(row));
}

}  // namespace

Hdf5Table::Hdf5Table(const hdf5::File& file, std::string group) : group_(std::move(group)) {
  const hdf5::Handle made = hdf5::create_group(file, group_.c_str());
}

void Hdf5Table::add_column(const hdf5::File& file, const std::string& name, hid_t stored_type,
                           const std::string& unit, const std::string& words) {
  const std::string path = group_ + "/" + name;
  columns_.push_back({name, {file, path.c_str(), stored_type, {}}, {}});
  const hid_t dataset = columns_.back().dataset.id();
  if (!unit.empty()) hdf5::Attributes(file, dataset).write(force_format::kUnit, unit);
  if (!words.empty()) hdf5::Attributes(file, dataset).write("words", words);
}

void Hdf5Table::put(double value) {
  if (next_column_ == 0) ++rows_;
  columns_[next_column_].waiting.push_back(value);
  next_column_ = (next_column_ + 1) % columns_.size();
}

void Hdf5Table::write() {
  for (Column& column : columns_) {
    column.dataset.append(H5T_NATIVE_DOUBLE, column.waiting.data(), column.waiting.size());
    column.waiting.clear();
  }
}

void Hdf5Table::close() {
  for (Column& column : columns_) column.dataset.close();
}

ContactTables::ContactTables(const hdf5::File& file, const ContactOptions& options) {
  columns_ = quantity_columns(options);
  contacts_ = {file, force_format::kContacts};
  const hdf5::Handle group =
      hdf5::own(H5Gopen2(file.id.get(), force_format::kContacts, H5P_DEFAULT), file.path,
                "its contacts cannot be written");
  const hdf5::Attributes attributes(file, group.get());
  attributes.write(force_format::kMinimumPillars, static_cast<double>(options.minimum_pillars));
  attributes.write(force_format::kReach, options.reach_mm);
  attributes.write(force_format::kGivenFriction, options.friction.given);
  contacts_.add_column(file, "frame", H5T_STD_U64LE, "");
  add_columns(file, identity_columns(), contacts_);
  add_columns(file, columns_, contacts_);

  patch_ = {file, force_format::kPatch};
  for (const char* name : force_format::kPatchRows)
    patch_.add_column(file, name, H5T_STD_U64LE, "");
  add_columns(file, columns_, patch_);

  ended_ = {file, force_format::kEnded};
  ended_.add_column(file, "frame", H5T_STD_U64LE, "");
  add_columns(file, ended_columns(), ended_);
}

void ContactTables::append(const FrameContacts& frame) {
  const auto index = static_cast<double>(frames());
  patch_.put(static_cast<double>(contacts_.rows()));
  patch_.put(static_cast<double>(frame.contacts.size()));
  patch_.put(static_cast<double>(ended_.rows()));
  patch_.put(static_cast<double>(frame.ended.size()));
  put_row(columns_, frame.total, patch_);
  for (const TrackedContact& contact : frame.contacts) {
    contacts_.put(index);
    put_row(identity_columns(), contact, contacts_);
    put_row(columns_, contact.quantities, contacts_);
  }
  for (const EndedContact& contact : frame.ended) {
    ended_.put(index);
    put_row(ended_columns(), contact, ended_);
  }
}

void ContactTables::write() {
  contacts_.write();
  ended_.write();
  // The patch table refers to rows of the other tables, so it is written last.
  patch_.write();
}

void ContactTables::close() {
  contacts_.close();
  patch_.close();
  ended_.close();
}

}  // namespace pillarfield
