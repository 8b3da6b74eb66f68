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

/// What a program writes.
enum class OutputKind : std::uint8_t {
  recording,
  calibration,
  forces,    ///< the ending of the path says in which format
  contacts,  ///< as forces
  png,
  svg,
  video,
  text,
};

/// The endings of files of forces or of contacts: ".csv or .json".
[[nodiscard]] std::string endings_of(OutputKind kind);

/// What an output may replace under its name; an empty file in any case but `nothing`.
enum class Replace : std::uint8_t {
  nothing,
  results,   ///< an earlier result of the same kind, by its content. Recordings, calibrations
             ///< and texts are no results: they cannot be made again.
  anything,  ///< any regular file
};

/// An output that a command is about to begin.
struct PlannedOutput {
  std::filesystem::path path;
  OutputKind kind = OutputKind::text;
};

/// Whether two paths lead to the same file, also through links and where it does not exist yet.
[[nodiscard]] bool name_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Looks at the outputs of a command before its work begins, and writes nothing. Throws Error where
/// one of them, under its name or under the name of its part, is a file of `inputs` (by device and
/// inode) or of another output, where it may not replace what bears its name, where another process
/// is writing it, or where its directory cannot be written. Empty paths in `inputs` are passed
/// over.
void check_outputs(const std::vector<std::filesystem::path>& inputs,
                   const std::vector<PlannedOutput>& outputs, Replace replace);

class LockedPart;

/// A file that is written as a part, its name and ".part", and takes its name in commit().
///
/// The part is locked (an open file description lock) before it is truncated, and until it has its
/// name: of two writers the second gets an Error. A symbolic link or a file with further names is
/// never taken for a part, nor is a part in which an earlier writer left what cannot be made again.
/// Where the final name is a symbolic link, the file that it leads to is the one that is written.
/// Destroyed before commit(), the part is removed unless it is kept.
class OutputFile {
 public:
  /// Parts that grow are written to the disk at most so often.
  static constexpr std::chrono::seconds kSyncInterval{5};

  /// Creates the part, empty. Throws Error where that or the final name is impossible, as
  /// check_outputs() does.
  OutputFile(std::filesystem::path path, OutputKind kind, Replace replace = Replace::results);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }  ///< as it was given
  [[nodiscard]] const std::filesystem::path& part_path() const { return part_path_; }

  /// Of the part, open for reading and writing until commit().
  [[nodiscard]] int descriptor() const;
  [[nodiscard]] bool is_open() const { return part_ != nullptr; }

  /// Appends. Throws Error where the disk is full. The caller gathers large blocks.
  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);

  /// Writes `text` over what stands at the file's beginning.
  void write_at_begin(std::string_view text);

  /// Begins to write the part to the disk, in a thread of its own, unless that was begun less than
  /// `interval` ago or still goes on. Throws Error where it failed before.
  void sync_at_intervals(std::chrono::steady_clock::duration interval = kSyncInterval);

  /// From now on the part outlives this object.
  void keep() { kept_ = true; }

  /// Writes the part to the disk and gives it its final name. Throws Error where that fails; the
  /// text tells where the data are.
  void commit();

 private:
  void put(std::span<const std::byte> bytes, std::uint64_t offset);
  void take_sync_result();
  void take_name();

  std::filesystem::path path_;
  std::filesystem::path final_path_;  // no symbolic link
  std::filesystem::path part_path_;
  OutputKind kind_;
  Replace replace_;
  std::unique_ptr<LockedPart> part_;
  std::uint64_t size_ = 0;  // of what write() has written
  std::chrono::steady_clock::time_point synced_;
  std::future<int> sync_;  // errno, or 0
  bool kept_ = false;
};

}  // namespace pillarfield
