#include "report/table.h"

#include <fmt/format.h>

namespace pillarfield::report {

Table::Table(std::string_view alignment, const std::vector<std::string>& header) {
  add(header);
  text_ += "|";
  for (const char side : alignment) text_ += side == 'r' ? "--:|" : "--|";
  text_ += "\n";
}

void Table::add(const std::vector<std::string>& cells) {
  text_ += fmt::format("| {} |\n", fmt::join(cells, " | "));
}

}  // namespace pillarfield::report
