#pragma once

#include <string>
#include <vector>

#include "io/hdf5/file.h"
#include "io/hdf5/filters.h"

namespace pillarfield::hdf5 {

/// How the values of a dataset lie in its file.
struct Storage {
  std::vector<hsize_t> extent;
  std::vector<hsize_t> chunk;  ///< empty: not in chunks
  Filters filters;             ///< none: a chunk has the size of its values
  std::size_t value_bytes = 0;

  [[nodiscard]] bool holds_values() const;
  [[nodiscard]] double chunk_bytes() const;
};

/// Reads it. Throws Error where the dataset is no array, lies in other files, or passes through
/// filters that are not read.
[[nodiscard]] Storage storage_of(const File& file, const Handle& dataset, const std::string& name);

/// Throws Error where the file is shorter than what the dataset claims to hold, or does not have
/// all its chunks: damaged headers must not make anyone ask for memory or write without end, nor
/// lost readings be taken for zeros. The chunks of a file that is still written are not counted.
void require_stored(const File& file, const Handle& dataset, const std::string& name,
                    const Storage& storage);

}  // namespace pillarfield::hdf5
