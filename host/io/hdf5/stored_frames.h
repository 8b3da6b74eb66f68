#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "io/hdf5/chunks.h"
#include "io/hdf5/file.h"

namespace pillarfield::hdf5 {

/// Largest number of values of a frame or plane in an untrusted file. All planes and results of
/// such a skin stay below 1 GB together.
inline constexpr std::size_t kMostUntrustedValues = std::size_t{1} << 23;

/// Throws Error if an untrusted file has more `values` in a frame or plane.
void require_frame_limit(const File& file, const std::string& name, double values);

/// A dataset [frames, ...] of numbers for reading, with its length at the time of opening.
class StoredFrames {
 public:
  StoredFrames() = default;

  /// Throws Error if the dataset does not have `frame_rank` dimensions beside the frames, does not
  /// hold plain numbers, claims more than its file stores, or has too large frames for an
  /// untrusted file. `may_lack_chunks` as in require_stored().
  StoredFrames(const File& file, const std::string& name, std::size_t frame_rank,
               bool may_lack_chunks = false);

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] std::uint64_t frames() const { return storage_.extent[0]; }

  /// Size of a frame in each dimension.
  [[nodiscard]] std::vector<hsize_t> shape() const {
    return {storage_.extent.begin() + 1, storage_.extent.end()};
  }

  /// True if the values are an enumeration, such as NumPy's booleans; type() is its integer.
  [[nodiscard]] bool is_enumeration() const { return is_enumeration_; }
  [[nodiscard]] hid_t type() const { return type_.get(); }
  [[nodiscard]] H5T_class_t value_class() const { return H5Tget_class(type_.get()); }

  /// Reads frame `index` < frames(), dense, converted to `memory_type`.
  void get(std::uint64_t index, hid_t memory_type, void* frame) const {
    get_all(index, 1, memory_type, frame);
  }

  /// Reads `count` frames from `first` on, all below frames().
  void get_all(std::uint64_t first, std::uint64_t count, hid_t memory_type, void* frames) const;

 private:
  void keep_inflated_chunks(const File& file);

  std::filesystem::path path_;
  std::string name_;
  bool is_trusted_ = false;
  Handle dataset_;
  Handle type_;  ///< of the values; for an enumeration, of its integers
  bool is_enumeration_ = false;
  Storage storage_;
  mutable std::set<std::uint64_t> whole_layers_;  ///< that require_whole_chunks() has passed
};

/// Reads a dataset [rows, cols] of any number type.
[[nodiscard]] std::vector<float> read_plane(const File& file, const char* name, std::size_t rows,
                                            std::size_t cols);

/// Writes a dataset [rows, cols].
void write_plane(const File& file, const char* name, hid_t stored_type, hid_t memory_type,
                 std::size_t rows, std::size_t cols, const void* values);

/// Overwrites a dataset that write_plane() wrote.
void rewrite_plane(const File& file, const char* name, hid_t memory_type, const void* values);

}  // namespace pillarfield::hdf5
