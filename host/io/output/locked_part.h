#pragma once

#include <filesystem>
#include <optional>

#include "io/output/output_place.h"
#include "io/output/part_bytes.h"

namespace pillarfield {

/// The part of an output, open and locked against other writers, before anything is written to it.
///
/// The lock is an open file description lock (fcntl). It ends with the last duplicate of the
/// descriptor, at the latest with the process, and is independent of HDF5's own locks (flock).
class LockedPart {
 public:
  /// Creates the part, or opens one that an earlier writer left. Throws Error if another process
  /// writes it, or if it is a symbolic link, has other names, or is not a regular file.
  explicit LockedPart(OutputPlace place);
  ~LockedPart();
  LockedPart(const LockedPart&) = delete;
  LockedPart& operator=(const LockedPart&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] PartBytes& bytes() { return *bytes_; }
  [[nodiscard]] bool was_there() const { return was_there_; }

  /// Whether the part's name still refers to this file.
  [[nodiscard]] bool has_its_name() const;

 private:
  bool open_and_lock();
  void require_unused() const;
  [[nodiscard]] bool lock() const;

  OutputPlace place_;
  int descriptor_ = -1;
  std::optional<PartBytes> bytes_;
  bool was_there_ = false;
};

/// Whether a part exists that LockedPart would open. Throws Error in the cases of LockedPart.
[[nodiscard]] bool is_part_left_over(const OutputPlace& place);

}  // namespace pillarfield
