#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Shape of one frame of a dataset [frames, ...]: {rows, cols} for a plane, {} for one number.
using FrameShape = std::vector<hsize_t>;

/// A dataset that grows frame by frame, of uncompressed chunks of about 256 KiB or one frame.
class GrowingDataset {
 public:
  GrowingDataset() = default;
  GrowingDataset(const File& file, const char* name, hid_t stored_type, const FrameShape& shape);

  /// Writes frame `index`, at most one beyond the last. `row_stride` counts values from one row to
  /// the next. The data are in the operating system's hands when it returns; that the dataset is
  /// longer reaches the file with the next flush.
  void put(std::uint64_t index, hid_t memory_type, const void* frame, std::size_t row_stride = 1);

  /// Writes `count` dense frames after the last, as put() does one.
  void append(hid_t memory_type, const void* frames, std::size_t count);

  /// To write attributes on it.
  [[nodiscard]] hid_t id() const { return dataset_.get(); }

  void close() { (void)dataset_.close(); }

 private:
  std::filesystem::path path_;
  std::string failure_;
  std::shared_ptr<WriteHealth> health_;
  Handle dataset_;
  std::vector<hsize_t> extent_;  // of the whole dataset
};

}  // namespace pillarfield::hdf5
