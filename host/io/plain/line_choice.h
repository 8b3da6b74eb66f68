#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "io/plain/table_columns.h"
#include "io/proposal.h"
#include "pillarfield/read_options.h"

namespace pillarfield {

/// The lines of a table that ReadOptions::where takes, and columns in which few words alternate, as
/// where the lines of two feet lie in one table.
class LineChoice {
 public:
  /// Throws Error, naming `place`, if the options name no column.
  LineChoice(const ReadOptions& options, std::span<const std::string> header, std::size_t count,
             const TableColumns& columns, const std::string& place);

  /// True if the line is one of those chosen.
  [[nodiscard]] bool takes(const std::vector<std::string>& cells);

  /// Throws Error, naming `place`, if no line was taken, or if a column alternates and nothing is
  /// chosen.
  void check(const std::string& place) const;

 private:
  static constexpr std::size_t kMostWords = 8;

  /// A column that is neither reading nor time.
  struct Watched {
    std::size_t column = 0;
    std::string name = {};
    std::set<std::string> words = {};  ///< at most one more than kMostWords
    std::string before = {};
    std::uint64_t changes = 0;
  };

  const ReadOptions& options_;
  std::optional<std::size_t> column_;  ///< that chooses
  std::string word_;                   ///< in it
  std::uint64_t lines_ = 0;
  std::uint64_t taken_ = 0;
  std::vector<Watched> watched_;
};

/// The way on for a table without names whose lines have more cells than a frame has sensels: the
/// columns that are neither words, nor constant, nor rise from line to line, if they are as many.
[[nodiscard]] std::vector<Proposal> proposals_by_cells(const std::filesystem::path& path,
                                                       char separator, std::size_t cells,
                                                       std::size_t sensels,
                                                       const ReadOptions& options);

}  // namespace pillarfield
