#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/hdf5/stored_frames.h"
#include "io/plain/number_array.h"

namespace pillarfield::hdf5 {

/// The type of a dataset's numbers. Throws Error for booleans and floats of 2 bytes.
[[nodiscard]] NumberType number_type_of(const StoredFrames& stored, const File& file);

/// HDF5's type of such numbers in memory.
[[nodiscard]] hid_t memory_type_of(NumberType type);

/// A dataset of 1 to 5 dimensions.
[[nodiscard]] std::unique_ptr<NumberArray> open_dataset(const std::shared_ptr<const File>& opened,
                                                        const std::string& name);

/// The paths of datasets of two or three dimensions, at most ten.
[[nodiscard]] std::vector<std::string> list_datasets(const File& file);

}  // namespace pillarfield::hdf5
