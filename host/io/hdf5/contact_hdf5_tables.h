#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "io/contact_columns.h"
#include "io/hdf5/file.h"
#include "io/hdf5/frames.h"
#include "pillarfield/contact_tracker.h"

namespace pillarfield {

/// A table: datasets [rows] of a group, one per column, extended together. Buffers rows until they
/// are written.
class Hdf5Table {
 public:
  Hdf5Table() = default;

  /// Creates the group; its parents must exist.
  Hdf5Table(const hdf5::File& file, std::string group);

  /// Creates a dataset; `words`, unless empty, lists the meanings of its values.
  void add_column(const hdf5::File& file, const std::string& name, hid_t stored_type,
                  const std::string& unit, const std::string& words = {});

  /// Appends one value of the current row, in the order of the columns.
  void put(double value);

  /// Writes all rows of a table of another file with the same columns; `shift_of` returns what is
  /// added to the values of a column that are not 0, or to all where `zero_too`.
  struct Shift {
    double by = 0;
    bool zero_too = false;
  };
  void append(const hdf5::File& file, const std::function<Shift(const std::string&)>& shift_of);

  [[nodiscard]] std::uint64_t rows() const { return rows_; }  ///< rows begun so far
  void write();
  void close();

 private:
  struct Column {
    std::string name;
    hdf5::ExtendibleDataset dataset;
    std::vector<double> waiting;
  };
  std::string group_;
  std::vector<Column> columns_;
  std::size_t next_column_ = 0;
  std::uint64_t rows_ = 0;
};

/// The group /contacts of a force file (docs/formats.md).
class ContactTables {
 public:
  ContactTables() = default;
  ContactTables(const hdf5::File& file, const ContactOptions& options);

  void append(const FrameContacts& frame);

  /// Appends the tables of a part that begins at the frame `first`. Its contacts get ids above the
  /// largest one so far.
  void append(const hdf5::File& part, std::uint64_t first);

  [[nodiscard]] std::uint64_t frames() const { return patch_.rows(); }
  void write();
  void close();

 private:
  QuantityColumns columns_;
  Hdf5Table contacts_;
  Hdf5Table patch_;
  Hdf5Table ended_;
  double largest_id_ = 0;  ///< of the parts appended
};

}  // namespace pillarfield
