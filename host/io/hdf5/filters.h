#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5/handle.h"

namespace pillarfield::hdf5 {

/// The filters of a dataset, gzip, shuffle and fletcher32, in the order of the writer. They are
/// undone here because HDF5 1.10 does not check the inflated size of a chunk and returns
/// uninitialised memory for missing bytes.
class Filters {
 public:
  Filters() = default;

  /// Reads the filters from a dataset's creation list. Throws Error if there is any other filter.
  /// `name` and `file` are for messages.
  Filters(const std::filesystem::path& file, const std::string& name, const Handle& creation_list,
          std::size_t value_bytes);

  [[nodiscard]] bool empty() const { return ids_.empty(); }

  /// Undoes all filters of a stored chunk except those whose bits are set in `skipped`. Throws
  /// Error unless the result has exactly `chunk_bytes` and matches its checksum.
  [[nodiscard]] std::vector<std::byte> undo(std::vector<std::byte> stored, std::uint32_t skipped,
                                            std::size_t chunk_bytes) const;

 private:
  [[noreturn]] void fail_on_chunk(const std::string& what) const;
  [[nodiscard]] std::vector<std::byte> inflated(const std::vector<std::byte>& stored,
                                                std::size_t bytes) const;
  [[nodiscard]] std::vector<std::byte> unshuffled(const std::vector<std::byte>& stored) const;
  void take_checksum(std::vector<std::byte>& stored) const;

  std::filesystem::path file_;
  std::string name_;
  std::size_t value_bytes_ = 0;
  std::vector<H5Z_filter_t> ids_;
};

}  // namespace pillarfield::hdf5
