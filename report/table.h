#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pillarfield::report {

/// A table in Markdown. `alignment` has a letter for each column: l for left, r for right.
class Table {
 public:
  Table(std::string_view alignment, const std::vector<std::string>& header);

  void add(const std::vector<std::string>& cells);
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

}  // namespace pillarfield::report
