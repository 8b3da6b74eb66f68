#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/hdf5_file.h"

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

/// A dataset [frames, ...] to read, with the length it had when it was opened.
class StoredFrames {
 public:
  StoredFrames() = default;

  /// Throws Error where the dataset has not `frame_rank` dimensions beside the frames, or claims
  /// more than its file can hold.
  StoredFrames(const File& file, const char* name, std::size_t frame_rank);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t frames() const { return extent_[0]; }
  [[nodiscard]] FrameShape shape() const { return {extent_.begin() + 1, extent_.end()}; }

  [[nodiscard]] H5T_class_t value_class() const;
  [[nodiscard]] bool value_signed() const;
  [[nodiscard]] std::size_t value_bytes() const;

  /// Reads frame `index` < frames(), dense, converted to `memory_type`.
  void get(std::uint64_t index, hid_t memory_type, void* frame) const;

  /// Reads `count` frames from `first` on, all below frames().
  void get_all(std::uint64_t first, std::uint64_t count, hid_t memory_type, void* frames) const;

 private:
  std::filesystem::path path_;
  std::string name_;
  Handle dataset_;
  Handle type_;
  std::vector<hsize_t> extent_;
};

}  // namespace pillarfield::hdf5
