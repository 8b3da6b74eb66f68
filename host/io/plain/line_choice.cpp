#include "io/plain/line_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "io/plain/column_names.h"
#include "io/plain/text_cells.h"
#include "io/tekscan/line_reader.h"

namespace pillarfield {

LineChoice::LineChoice(const ReadOptions& options, std::span<const std::string> header,
                       std::size_t count, const TableColumns& columns, const std::string& place)
    : options_(options) {
  const std::size_t equals = options.where.find('=');
  const std::string name(without_blanks(options.where.substr(0, equals)));
  for (std::size_t i = 0; i < count; ++i) {
    const std::string here = i < header.size() ? header[i] : "";
    if (!options.where.empty() && (here == name || std::to_string(i + 1) == name)) column_ = i;
    if (std::ranges::count(columns.readings, i) == 0 && columns.time != i) {
      watched_.push_back({i, here.empty() ? std::to_string(i + 1) : here});
    }
  }
  if (options.where.empty()) return;
  if (!column_ || equals == std::string::npos) {
    throw Error(place, fmt::format("has no lines by --where '{:.60}'", options.where),
                "give a column, by name or number, and its word, such as side=L");
  }
  word_ = without_blanks(options.where.substr(equals + 1));
}

bool LineChoice::takes(const std::vector<std::string>& cells) {
  const bool is_taken = !column_ || cells[*column_] == word_;
  if (is_taken) ++taken_;
  for (Watched& watched : watched_) {
    // With a choice, other columns may still alternate in the lines that it takes.
    if ((!is_taken && watched.column != *column_) || watched.words.size() > kMostWords) continue;
    const std::string& word = cells[watched.column];
    if (!watched.words.empty() && word != watched.before) ++watched.changes;
    watched.words.insert(word);
    watched.before = word;
  }
  ++lines_;
  return is_taken;
}

void LineChoice::check(const std::string& place) const {
  for (const Watched& watched : watched_) {
    const auto& words = watched.words;
    if (column_ == watched.column && taken_ == 0) {
      throw Error(place, fmt::format("has no line by --where '{:.60}'", options_.where),
                  fmt::format("'{}' has {}", watched.name, fmt::join(words, ", ")));
    }
    // States of time, such as an activity, change seldom; so do noise and flags, half the time.
    constexpr double kLeastChanges = 0.6;
    constexpr std::uint64_t kLeastLines = 6;
    const bool alternates =
        words.size() > 1 && words.size() <= kMostWords && !words.contains("") &&
        taken_ >= kLeastLines &&
        static_cast<double>(watched.changes) >= kLeastChanges * static_cast<double>(taken_ - 1);
    if (column_ == watched.column || !alternates) continue;
    std::vector<Proposal> proposals;
    ReadOptions chosen = options_;
    chosen.where = watched.name + "=" + *words.begin();
    if (options_.where.empty() && chosen.where.find('\'') == std::string::npos) {
      proposals.push_back({fmt::format("--where '{}'", chosen.where), chosen});
    }
    throw ProposingError(place,
                         fmt::format("'{}' alternates between {}, as lines of several arrays do",
                                     watched.name, fmt::join(words, ", ")),
                         "choose one with --where COLUMN=WORD", "choose one, as with",
                         std::move(proposals));
  }
}

std::vector<Proposal> proposals_by_cells(const std::filesystem::path& path, char separator,
                                         std::size_t cells, std::size_t sensels,
                                         const ReadOptions& options) {
  constexpr int kMostLines = 1000;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> before(cells, kNone);
  std::vector<bool> is_reading(cells, true);
  std::vector<bool> rises(cells, true);
  LineReader reader(path);
  std::vector<std::string> line;
  int lines = 0;
  while (lines < kMostLines && reader.next()) {
    split_cells(reader.line(), separator, line);
    if (line.size() != cells) continue;
    ++lines;
    for (std::size_t i = 0; i < cells; ++i) {
      double value = kNone;
      is_reading[i] = is_reading[i] && read_cell(line[i], separator, value);
      rises[i] = rises[i] && !(value <= before[i]);
      before[i] = value;
    }
  }
  ColumnFamily kind;
  for (std::size_t i = 0; i < cells; ++i) {
    if (is_reading[i] && !rises[i]) kind.columns.push_back(i);
  }
  if (lines < 3 || kind.columns.size() != sensels) return {};
  ReadOptions chosen = options;
  chosen.columns = choice_of({}, kind);
  return {{fmt::format("--columns '{}'", chosen.columns), chosen}};
}

}  // namespace pillarfield
