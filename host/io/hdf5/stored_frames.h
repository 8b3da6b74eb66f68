#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/hdf5/chunks.h"
#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Values of a frame or plane that a file may have unless it is trusted: all planes of such a skin,
/// and its results, stay below a gigabyte together.
inline constexpr std::size_t kMostProbedValues = std::size_t{1} << 23;

/// Throws Error where a file that is probed has more `values` in a frame or plane.
void require_modest(const File& file, const std::string& name, double values);

/// A dataset [frames, ...] of numbers to read, with the length it had when it was opened.
class StoredFrames {
 public:
  StoredFrames() = default;

  /// Throws Error where the dataset has not `frame_rank` dimensions beside the frames, holds no
  /// plain numbers, or claims more than its file stores. In a file that is probed its frames must
  /// have at most kMostProbedValues, and its first and last value are read.
  StoredFrames(const File& file, const std::string& name, std::size_t frame_rank);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t frames() const { return storage_.extent[0]; }

  /// Size of a frame in each of its dimensions.
  [[nodiscard]] std::vector<hsize_t> shape() const {
    return {storage_.extent.begin() + 1, storage_.extent.end()};
  }

  [[nodiscard]] hid_t type() const { return type_.get(); }
  [[nodiscard]] H5T_class_t value_class() const { return H5Tget_class(type_.get()); }

  /// Reads frame `index` < frames(), dense, converted to `memory_type`.
  void get(std::uint64_t index, hid_t memory_type, void* frame) const {
    get_all(index, 1, memory_type, frame);
  }

  /// Reads `count` frames from `first` on, all below frames().
  void get_all(std::uint64_t first, std::uint64_t count, hid_t memory_type, void* frames) const;

 private:
  void touch() const;
  void read_selection(const std::vector<hsize_t>& start, const std::vector<hsize_t>& count,
                      hid_t memory_type, void* values) const;

  std::filesystem::path path_;
  std::string name_;
  Handle dataset_;
  Handle type_;  ///< of the values; of an enumeration its integers'
  Storage storage_;
  std::unique_ptr<FilteredChunks> chunks_;  ///< where the values pass through filters
};

}  // namespace pillarfield::hdf5
