#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/hdf5/handle.h"

namespace pillarfield::hdf5 {

/// How the chunks of a dataset are stored: gzip, shuffle and fletcher32, in the order in which the
/// writer applied them. We undo them ourselves: HDF5 1.10 does not compare what a chunk inflates to
/// with the size of a chunk, and gives memory of the process for what is missing.
class Filters {
 public:
  Filters() = default;

  /// Of a dataset's creation list. Throws Error where there is another filter. `name` and `file`
  /// are for messages.
  Filters(const std::filesystem::path& file, const std::string& name, const Handle& creation_list,
          std::size_t value_bytes);

  [[nodiscard]] bool empty() const { return ids_.empty(); }

  /// A stored chunk as it was before all filters but those of the bits of `skipped`. Throws Error
  /// unless it comes to `chunk_bytes` exactly and fits its checksum.
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
