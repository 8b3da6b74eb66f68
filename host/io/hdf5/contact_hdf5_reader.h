#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/contact_columns.h"
#include "io/hdf5/file.h"
#include "io/hdf5/stored_frames.h"
#include "pillarfield/contact_tracker.h"

namespace pillarfield {

/// Reads the group /contacts of a force file.
class ContactTablesReader {
 public:
  /// Throws Error if a table lacks a column or options are out of range.
  ContactTablesReader(const hdf5::File& file, SkinLayout layout);

  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] const ContactOptions& options() const { return options_; }

  /// Reads frame `index` < frames(), without its time. Throws Error if the tables contradict each
  /// other or the frame claims more than a million contacts.
  [[nodiscard]] FrameContacts read(std::uint64_t index) const;

 private:
  /// The datasets of a group in the order of its columns, and their common number of rows.
  struct Table {
    std::vector<std::optional<hdf5::StoredFrames>> columns;  ///< unset: absent
    std::uint64_t rows = 0;

    void open(const hdf5::File& file, const std::string& group, const char* name,
              bool optional = false);
  };

  void read_options(const hdf5::File& file);
  void open_tables(const hdf5::File& file);
  void drop_frames_without_rows();
  [[nodiscard]] bool has_rows_of(std::uint64_t index) const;
  [[nodiscard]] std::uint64_t count_at(std::size_t column, std::uint64_t index) const;
  void require_rows(const Table& table, std::uint64_t first, std::uint64_t count) const;

  std::filesystem::path path_;
  ContactOptions options_;
  QuantityColumns columns_;
  Table contacts_;
  Table patch_;  ///< the columns of kPatchRows first
  Table ended_;
  std::uint64_t frames_ = 0;
};

}  // namespace pillarfield
