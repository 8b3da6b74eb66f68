#pragma once

#include <filesystem>

#include "io/output/output_place.h"

namespace pillarfield {

/// The part of an output, open and locked against other writers; nothing is written to it yet.
///
/// The lock is one of fcntl()'s open file description locks: it ends with the last duplicate of the
/// descriptor, that is with the process at the latest, and HDF5's own locks (flock) know nothing
/// of it.
class LockedPart {
 public:
  /// Creates the part, or opens one that an earlier writer left. Throws Error where another process
  /// writes it, or where it is a symbolic link, has further names, or is no regular file.
  explicit LockedPart(OutputPlace place);
  ~LockedPart();
  LockedPart(const LockedPart&) = delete;
  LockedPart& operator=(const LockedPart&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] bool was_there() const { return was_there_; }

  /// Whether its name still stands for this file.
  [[nodiscard]] bool has_its_name() const;

 private:
  bool open_and_lock();
  void require_unused() const;
  [[nodiscard]] bool lock() const;

  OutputPlace place_;
  int descriptor_ = -1;
  bool was_there_ = false;
};

/// Throws Error where LockedPart would; whether there is a part that it would take over.
[[nodiscard]] bool is_part_left_over(const OutputPlace& place);

}  // namespace pillarfield
