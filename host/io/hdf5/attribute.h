#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/hdf5/file.h"
#include "pillarfield/pitch.h"

namespace pillarfield::hdf5 {

/// The attributes of an open group or dataset.
class Attributes {
 public:
  /// Those of the root, or of `object`, which must stay open.
  explicit Attributes(const File& file) : Attributes(file, file.id.get()) {}
  Attributes(const File& file, hid_t object) : file_(file), object_(object) {}

  /// Writes an attribute of one value: a 64-bit integer, a 64-bit float or a UTF-8 string of fixed
  /// length. HDF5 guards fixed-length strings with a checksum; a damaged string of variable length
  /// can crash it.
  void write(const char* name, int value) const;
  void write(const char* name, double value) const;
  void write(const char* name, const std::string& value) const;
  /// Writes a list of 64-bit floats.
  void write(const char* name, const std::vector<double>& values) const;
  /// Writes a pitch as one number, or as two: from row to row, from column to column.
  void write(const char* name, const Pitch& pitch) const;
  /// Writes a value that is set.
  template <class Value>
  void write(const char* name, const std::optional<Value>& value) const {
    if (value) write(name, *value);
  }
  /// Replaces the value of an attribute of numbers, also while frames are appended.
  void rewrite(const char* name, double value) const;

  /// Reads an attribute of any standard integer, float or string type; unset if absent. Throws
  /// Error if it is not a single number or string.
  [[nodiscard]] std::optional<double> number(const char* name) const;
  [[nodiscard]] std::optional<std::string> text(const char* name) const;
  /// Reads an attribute of one or several numbers, at most 65536; unset if absent.
  [[nodiscard]] std::optional<std::vector<double>> numbers(const char* name) const;
  /// Reads a pitch; unset if absent. Throws Error if it has neither one nor two numbers.
  [[nodiscard]] std::optional<Pitch> pitch(const char* name) const;

 private:
  const File& file_;
  hid_t object_;
};

}  // namespace pillarfield::hdf5
