#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pillarfield {

/// The arrays of a file that holds several, by name, for the choice of one. An index counts the
/// calls of add().
class ArrayNames {
 public:
  explicit ArrayNames(std::filesystem::path path) : path_(std::move(path)) {}

  void add(std::string name, std::size_t dimensions);
  /// An array that is not read, and why.
  void refuse(const std::string& name, std::string why);

  /// The named array, or the only one of three dimensions or more, or of two if none has three.
  /// Throws Error, naming the arrays, if there is no such array.
  [[nodiscard]] std::size_t array_of_frames(const std::string& name) const;

  /// The named array, or `time` if the name is empty; unset if there is no `time`. Throws Error if
  /// there is no array of the name.
  [[nodiscard]] std::optional<std::size_t> array_of_times(const std::string& name) const;

 private:
  struct NamedArray {
    std::string name;
    std::size_t dimensions;
  };

  [[nodiscard]] std::optional<std::size_t> find(const std::string& name) const;
  [[nodiscard]] std::size_t require(const std::string& name) const;

  std::filesystem::path path_;
  std::vector<NamedArray> arrays_;
  std::map<std::string, std::string> refused_;  // name, and why
};

}  // namespace pillarfield
