#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pillarfield {

/// The format of an output.
enum class OutputKind : std::uint8_t {
  recording,
  calibration,
  forces,    ///< the format follows from the path's extension
  contacts,  ///< likewise
  messages,  ///< .mcap
  png,
  video,
  text,
};

/// The file name extensions of forces or of contacts: ".csv or .json".
[[nodiscard]] std::string endings_of(OutputKind kind);

/// The existing files that an output may replace. All but `nothing` replace an empty file.
enum class Replace : std::uint8_t {
  nothing,
  results,   ///< an earlier result of the same kind and format: forces, contacts, pictures, videos
  anything,  ///< any regular file
};

/// An output that a program is about to write.
struct PlannedOutput {
  std::filesystem::path path;
  OutputKind kind = OutputKind::text;
};

/// True if two paths lead to the same file, links and files that do not exist yet included.
[[nodiscard]] bool name_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Checks the outputs of a program before its work begins; writes nothing. Throws Error if an
/// output or its part is an input (by device and inode) or another output, may not replace the
/// existing file, is being written by another process, or lies in a directory that cannot be
/// written. Empty paths in `inputs` are ignored.
void check_outputs(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<PlannedOutput>& outputs, Replace replace);

class LockedPart;

/// A file that is written as a part, `path` + ".part", which commit() renames to `path`.
///
/// The part is locked (an open file description lock) from before it is truncated until it is
/// renamed: a second writer gets an Error. Symbolic links, files with several names, and parts
/// whose content cannot be made again are never used as the part. If `path` is a symbolic link, its
/// target is written. The destructor removes a part that is neither committed nor kept.
class OutputFile {
 public:
  /// Default interval of sync_at_intervals().
  static constexpr std::chrono::seconds kSyncInterval{5};

  /// Creates an empty part. Throws Error in the cases of check_outputs().
  OutputFile(std::filesystem::path path, OutputKind kind, Replace replace = Replace::results);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }  ///< as given
  [[nodiscard]] const std::filesystem::path& part_path() const { return part_path_; }

  /// The part's file descriptor, open for reading and writing until commit().
  [[nodiscard]] int descriptor() const;
  [[nodiscard]] bool is_open() const { return part_ != nullptr; }

  /// Appends. Throws Error if the disk is full. Unbuffered: pass large blocks.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Overwrites the beginning of the file.
  void write_at_begin(std::string_view text);

  /// Starts fsync of the part in another thread, unless the last one started less than `interval`
  /// ago or is still running. Throws Error if an earlier one failed.
  void sync_at_intervals(std::chrono::steady_clock::duration interval = kSyncInterval);

  /// Lets the part outlive this object.
  void keep() { kept_ = true; }

  /// Writes the part to the disk and renames it to its final name. Throws Error if that fails; its
  /// text names the file that holds the data.
  void commit();

 private:
  void put(std::span<const std::byte> bytes, std::uint64_t offset);
  void take_sync_result();
  void take_name();

  std::filesystem::path path_;
  std::filesystem::path final_path_;  // after following symbolic links
  std::filesystem::path part_path_;
  OutputKind kind_;
  Replace replace_;
  std::unique_ptr<LockedPart> part_;
  std::uint64_t size_ = 0;  // bytes written by write()
  std::chrono::steady_clock::time_point synced_;
  std::future<int> sync_;  // errno, or 0
  bool kept_ = false;
};

}  // namespace pillarfield
