#include "cli/options/help.h"

#include <fmt/format.h>

#include <sstream>

namespace pillarfield::cli {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kIndent = 26;  // of descriptions

/// Wraps `text` into lines with `indent` columns before them; the first already has `used`.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t used) {
  std::string lines;
  std::size_t column = used;
  if (used + 2 > indent && indent > 0) {
    lines += '\n';
    column = 0;
  }
  lines.append(indent - column, ' ');
  column = indent;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (column > indent && column + 1 + word.size() > kWidth) {
      lines += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
  }
  return lines + '\n';
}

std::string row(const std::string& name, const std::string& description) {
  const std::string left = "  " + name;
  return left + wrapped(description, kIndent, left.size());
}

/// Returns a name such as "-o, --output FILE".
std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  names += "--" + option.get_lnames().front();
  const bool is_flag = option.get_expected_max() == 0;
  return is_flag ? names : fmt::format("{} {}", names, option.get_type_name());
}

/// Returns the line of required and positional arguments.
std::string usage(const CLI::App& app) {
  std::string line = "Usage: " + full_name(app);
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty() || !(option->get_positional() || option->get_required())) {
      continue;
    }
    std::string words = name_of(*option);
    if (words.starts_with("-o, ")) words = "-o " + option->get_type_name();
    if (option->get_positional() && option->get_expected_max() > 1) words += "...";
    line += option->get_required() ? " " + words : " [" + words + "]";
  }
  return line + (app.get_subcommands({}).empty() ? "" : " COMMAND") + " [OPTION...]\n";
}

}  // namespace

std::string full_name(const CLI::App& app) {
  return app.get_parent() == nullptr ? app.get_name()
                                     : full_name(*app.get_parent()) + " " + app.get_name();
}

std::string help_of(const CLI::App& app) {
  std::string text = wrapped(app.get_description(), 0, 0) + "\n" + usage(app);
  const std::vector<const CLI::App*> commands = app.get_subcommands({});
  if (!commands.empty()) text += "\nCommands:\n";
  for (const CLI::App* command : commands) {
    text += row(command->get_name(), command->get_description());
  }
  for (const std::string& group : app.get_groups()) {
    if (group.empty()) continue;
    text += fmt::format("\n{}:\n", group);
    for (const CLI::Option* option : app.get_options()) {
      if (option->get_group() == group) text += row(name_of(*option), option->get_description());
    }
  }
  return text + "\nExamples:\n" + app.get_footer();
}

}  // namespace pillarfield::cli
