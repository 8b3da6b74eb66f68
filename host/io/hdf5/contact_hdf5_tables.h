#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/hdf5/file.h"
#include "io/hdf5/frames.h"
#include "pillarfield/contact_columns.h"
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

  [[nodiscard]] std::uint64_t frames() const { return patch_.rows(); }
  void write();
  void close();

 private:
  QuantityColumns columns_;
  Hdf5Table contacts_;
  Hdf5Table patch_;
  Hdf5Table ended_;
};

}  // namespace pillarfield
