#include "io/plain/column_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <map>
#include <set>
#include <string_view>
#include <utility>

#include "io/plain/text_cells.h"

namespace pillarfield {
namespace {

using WordSet = std::set<std::string, std::less<>>;

const WordSet kRowWords = {"r", "row", "rows", "y"};
const WordSet kColWords = {"c", "col", "cols", "column", "columns", "x"};
const WordSet kSensorWords = {"sensor", "pad",  "board", "module", "device", "finger",
                              "hand",   "foot", "skin",  "array",  "patch",  "unit"};
const WordSet kReadingWords = {"f",       "force",   "forces", "pressure", "press",   "pressures",
                               "fsr",     "sensor",  "sensel", "taxel",    "tactile", "normal",
                               "sensors", "taxels",  "pad",    "touch",    "p",       "s",
                               "ch",      "channel", "data",   "adc",      "cell",    "raw"};

/// A name in parts: texts, and the numbers between them.
struct NameParts {
  std::vector<std::string> texts;  // one more than numbers
  std::vector<std::string> digits;

  explicit NameParts(std::string_view name) : texts(1) {
    for (const char letter : name) {
      const bool is_digit = letter >= '0' && letter <= '9';
      if (is_digit && (digits.size() < texts.size())) digits.emplace_back();
      if (!is_digit && digits.size() == texts.size()) texts.emplace_back();
      (is_digit ? digits : texts).back() += letter;
    }
    if (digits.size() == texts.size()) texts.emplace_back();
  }

  /// The name with '*' for the numbers of which `stars` is true.
  [[nodiscard]] std::string pattern(const std::vector<bool>& stars) const {
    std::string name = texts[0];
    for (std::size_t i = 0; i < digits.size(); ++i) {
      name += (stars[i] ? "*" : digits[i]) + texts[i + 1];
    }
    return name;
  }
  [[nodiscard]] std::uint64_t number(std::size_t at) const {
    std::uint64_t value = 0;
    const std::string& text = digits[at];
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    return read.ec == std::errc{} ? value : std::numeric_limits<std::uint64_t>::max();
  }
  /// The last word before a number.
  [[nodiscard]] std::string word_before(std::size_t at) const {
    const auto words = words_in(texts[at]);
    return words.empty() ? "" : words.back();
  }
};

/// The positions of numbers that differ among names of one kind: all, and those of row and column.
struct Varying {
  std::vector<std::size_t> order;  // of those that order the columns, row before column
  bool states_places = false;
};

Varying varying_of(const std::vector<NameParts>& names) {
  std::vector<std::size_t> differ;
  for (std::size_t at = 0; at < names[0].digits.size(); ++at) {
    const auto differs = [&](const NameParts& name) {
      return name.number(at) != names[0].number(at);
    };
    if (std::ranges::any_of(names, differs)) differ.push_back(at);
  }
  const auto with = [&](const WordSet& words) {
    return std::ranges::find_if(
        differ, [&](std::size_t at) { return words.contains(names[0].word_before(at)); });
  };
  const auto row = with(kRowWords);
  const auto col = with(kColWords);
  if (row != differ.end() && col != differ.end()) return {{*row, *col}, true};
  if (differ.size() > 2) return {{differ.end() - 2, differ.end()}};
  const auto sensor = with(kSensorWords);
  if (differ.size() == 2 && sensor != differ.end()) differ.erase(sensor);
  return {differ};
}

bool are_letters_in_a_row(std::vector<std::string> words) {
  if (words.empty()) return false;
  std::ranges::sort(words);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].size() != 1 || words[i][0] != words[0][0] + static_cast<int>(i)) return false;
  }
  return true;
}

/// The one word in which the patterns differ, of each kind; nothing if they differ otherwise.
std::vector<std::string> differing_words(const std::vector<ColumnFamily>& kinds) {
  std::vector<std::vector<std::string>> words;
  for (const ColumnFamily& kind : kinds) words.push_back(words_in(kind.pattern));
  std::vector<std::string> differing;
  for (std::size_t at = 0; at < words[0].size(); ++at) {
    const auto is_like_first = [&](const auto& each) {
      return each.size() == words[0].size() && each[at] == words[0][at];
    };
    if (std::ranges::all_of(words, is_like_first)) continue;
    if (!differing.empty()) return {};
    for (const auto& each : words) {
      if (each.size() != words[0].size()) return {};
      differing.push_back(each[at]);
    }
  }
  return differing;
}

/// Distinct values of a number of the columns.
std::set<std::uint64_t> values_at(const ColumnFamily& kind, std::size_t at) {
  std::set<std::uint64_t> values;
  for (const auto& numbers : kind.numbers) values.insert(numbers[at]);
  return values;
}

/// Positions of x, y or z, alone or at the end of a word.
std::vector<std::size_t> axis_letters(std::string_view name) {
  const auto is_letter = [&](std::size_t at) {
    return at < name.size() && std::isalpha(static_cast<unsigned char>(name[at])) != 0;
  };
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const int letter = std::tolower(static_cast<unsigned char>(name[i]));
    if (letter >= 'x' && letter <= 'z' && !is_letter(i + 1)) found.push_back(i);
  }
  return found;
}

}  // namespace

std::vector<ColumnFamily> kinds_of(std::span<const std::string> header,
                                   std::span<const std::size_t> columns) {
  std::map<std::vector<std::string>, std::vector<std::size_t>> alike;
  for (const std::size_t column : columns) {
    alike[NameParts(header[column]).texts].push_back(column);
  }
  std::vector<ColumnFamily> kinds;
  std::map<std::string, std::size_t> known;  // of a pattern
  for (const auto& [texts, members] : alike) {
    std::vector<NameParts> names;
    for (const std::size_t column : members) names.emplace_back(header[column]);
    const Varying varying = varying_of(names);
    std::vector<bool> stars(texts.size() - 1);
    for (const std::size_t at : varying.order) stars[at] = true;
    for (std::size_t i = 0; i < members.size(); ++i) {
      const auto [kind, is_new] = known.emplace(names[i].pattern(stars), kinds.size());
      if (is_new) kinds.push_back({kind->first, {}, {}, varying.states_places});
      kinds[kind->second].columns.push_back(members[i]);
      auto& numbers = kinds[kind->second].numbers.emplace_back();
      for (const std::size_t at : varying.order) numbers.push_back(names[i].number(at));
    }
  }
  std::ranges::sort(kinds, {}, [](const ColumnFamily& kind) { return kind.columns.front(); });
  for (ColumnFamily& kind : kinds) {
    std::vector<std::pair<std::vector<std::uint64_t>, std::size_t>> order;
    for (std::size_t i = 0; i < kind.columns.size(); ++i) {
      order.emplace_back(kind.numbers[i], kind.columns[i]);
    }
    const auto sorted = std::set(kind.numbers.begin(), kind.numbers.end());
    if (sorted.size() < order.size()) continue;  // Names that come again are in order.
    std::ranges::sort(order);
    for (std::size_t i = 0; i < order.size(); ++i) {
      std::tie(kind.numbers[i], kind.columns[i]) = order[i];
    }
  }
  if (are_rows(kinds) && are_letters_in_a_row(differing_words(kinds))) {
    std::ranges::stable_sort(kinds, {},
                             [](const ColumnFamily& kind) { return words_in(kind.pattern); });
  }
  return kinds;
}

bool are_rows(const std::vector<ColumnFamily>& kinds) {
  if (kinds.size() < 2) return false;
  const auto is_row = [&](const ColumnFamily& kind) {
    return kind.numbers == kinds[0].numbers && kind.columns.size() > 1 &&
           kind.numbers[0].size() == 1;
  };
  if (!std::ranges::all_of(kinds, is_row)) return false;
  std::vector<std::string> words = differing_words(kinds);
  std::ranges::sort(words);
  return words == std::vector<std::string>{"l", "r"} ||
         words == std::vector<std::string>{"left", "right"} || are_letters_in_a_row(words);
}

std::optional<FrameSize> stated_size(const std::vector<ColumnFamily>& kinds) {
  std::size_t rows = kinds.size();
  std::size_t cols = kinds[0].columns.size();
  if (kinds.size() > 1 && !are_rows(kinds)) return std::nullopt;
  if (kinds.size() == 1) {
    if (kinds[0].numbers[0].size() != 2) return std::nullopt;
    const auto values = [&](std::size_t at) { return values_at(kinds[0], at); };
    rows = values(0).size();
    cols = values(1).size();
    if (kinds[0].states_places) {
      rows = *values(0).rbegin() - *values(0).begin() + 1;
      cols = *values(1).rbegin() - *values(1).begin() + 1;
      // Numbers far apart are no places.
      if (rows > 65534 || cols > 65534 || rows * cols > 4 * kinds[0].columns.size()) {
        return std::nullopt;
      }
    } else if (rows * cols != kinds[0].columns.size()) {
      return std::nullopt;
    }
    const auto& numbers = kinds[0].numbers;
    if (std::set(numbers.begin(), numbers.end()).size() < numbers.size()) return std::nullopt;
  }
  if (rows < 2 || cols < 2) return std::nullopt;
  return FrameSize{static_cast<std::uint32_t>(rows), static_cast<std::uint32_t>(cols)};
}

std::vector<std::size_t> in_order(const std::vector<ColumnFamily>& kinds,
                                  const std::optional<FrameSize>& size) {
  std::vector<std::size_t> columns;
  if (size && kinds.size() == 1 && kinds[0].states_places) {
    columns.assign(std::size_t{size->rows} * size->cols, kNoColumn);
    const std::uint64_t first_row = *values_at(kinds[0], 0).begin();
    const std::uint64_t first_col = *values_at(kinds[0], 1).begin();
    for (std::size_t i = 0; i < kinds[0].columns.size(); ++i) {
      const auto& numbers = kinds[0].numbers[i];
      columns[(numbers[0] - first_row) * size->cols + numbers[1] - first_col] = kinds[0].columns[i];
    }
    return columns;
  }
  for (const ColumnFamily& kind : kinds) {
    columns.insert(columns.end(), kind.columns.begin(), kind.columns.end());
  }
  return columns;
}

std::vector<Components> components_of(const std::vector<ColumnFamily>& kinds,
                                      std::vector<ColumnFamily>& others) {
  std::map<std::string, const ColumnFamily*> by_pattern;
  for (const ColumnFamily& kind : kinds) by_pattern[kind.pattern] = &kind;
  std::map<std::string, Components> found;  // by the word of the axis
  for (const ColumnFamily& kind : kinds) {
    bool is_component = false;
    for (const std::size_t at : axis_letters(kind.pattern)) {
      std::array<const ColumnFamily*, 3> axes = {};
      std::string name = kind.pattern;
      const char x = std::isupper(static_cast<unsigned char>(name[at])) != 0 ? 'X' : 'x';
      for (std::size_t axis = 0; axis < 3; ++axis) {
        name[at] = static_cast<char>(x + static_cast<int>(axis));
        const auto each = by_pattern.find(name);
        if (each != by_pattern.end() && each->second->numbers == kind.numbers)
          axes[axis] = each->second;
      }
      if (std::ranges::count(axes, nullptr) > 0) continue;
      is_component = true;
      if (axes[0] != &kind) break;
      std::size_t begin = at;
      while (begin > 0 && std::isalpha(static_cast<unsigned char>(name[begin - 1])) != 0) --begin;
      Components& all =
          found[name.substr(begin, at - begin) + (kind.columns.size() > 1 ? "*" : "")];
      ColumnFamily* const to[] = {&all.x, &all.y, &all.z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        to[axis]->pattern += (to[axis]->pattern.empty() ? "" : ",") + axes[axis]->pattern;
        for (const std::size_t column : axes[axis]->columns) to[axis]->columns.push_back(column);
      }
      const auto words = words_in(kind.pattern);
      all.is_force = all.is_force || std::ranges::count(words, "force") > 0 ||
                     (begin < at && std::tolower(static_cast<unsigned char>(name[begin])) == 'f');
      break;
    }
    if (!is_component) others.push_back(kind);
  }
  std::vector<Components> list;
  for (auto& [word, all] : found) list.push_back(std::move(all));
  return list;
}

bool names_readings(const std::string& name) {
  return std::ranges::any_of(words_in(name),
                             [](const auto& word) { return kReadingWords.contains(word); });
}

std::string choice_of(std::span<const std::string> header, const ColumnFamily& kind) {
  std::set<std::size_t> fitting;
  std::string_view rest = kind.pattern;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    for (std::size_t i = 0; i < header.size(); ++i) {
      if (fits_pattern(header[i], without_blanks(rest.substr(0, end)))) fitting.insert(i);
    }
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  const std::set<std::size_t> wanted(kind.columns.begin(), kind.columns.end());
  constexpr std::size_t kLongest = 80;
  const bool is_number = kind.pattern.find_first_not_of("0123456789-:,") == std::string::npos;
  if (fitting == wanted && !is_number && kind.pattern.size() <= kLongest &&
      kind.pattern.find_first_of("'\"\\") == std::string::npos) {
    return kind.pattern;
  }
  std::vector<std::string> ranges;
  for (auto first = wanted.begin(); first != wanted.end();) {
    auto last = first;
    while (std::next(last) != wanted.end() && *std::next(last) == *last + 1) ++last;
    ranges.push_back(*first == *last ? fmt::format("{}", *first + 1)
                                     : fmt::format("{}-{}", *first + 1, *last + 1));
    first = std::next(last);
  }
  return fmt::format("{}", fmt::join(ranges, ","));
}

bool fits_pattern(std::string_view name, std::string_view pattern) {
  if (pattern.empty()) return name.empty();
  if (pattern[0] != '*')
    return !name.empty() && (pattern[0] == '?' || pattern[0] == name[0]) &&
           fits_pattern(name.substr(1), pattern.substr(1));
  for (std::size_t skipped = 0; skipped <= name.size(); ++skipped) {
    if (fits_pattern(name.substr(skipped), pattern.substr(1))) return true;
  }
  return false;
}

}  // namespace pillarfield
