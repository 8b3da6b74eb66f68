#include "cli/help.h"

#include <fmt/format.h>

#include <sstream>

namespace pillarfield::cli {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kIndent = 26;  // of descriptions

/// `text` in lines that start after `indent` columns, of which `used` are taken in the first.
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

/// "-o, --output FILE".
std::string name_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  names += "--" + option.get_lnames().front();
  const bool is_flag = option.get_expected_max() == 0;
  return is_flag ? names : fmt::format("{} {}", names, option.get_type_name());
}

std::string usage(const CLI::App& app) {
  std::string line = "Usage: " + full_name(app);
  bool has_more = false;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    if (option->get_positional()) {
      const std::string name =
          option->get_name(true) + (option->get_expected_max() > 1 ? "..." : "");
      line += option->get_required() ? " " + name : " [" + name + "]";
    } else if (!option->get_required()) {
      has_more = true;
    }
  }
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() || !option->get_required()) continue;
    const bool has_short = !option->get_snames().empty();
    line += fmt::format(
        " {} {}",
        has_short ? "-" + option->get_snames().front() : "--" + option->get_lnames().front(),
        option->get_type_name());
  }
  const bool has_commands = !app.get_subcommands({}).empty();
  return line + (has_commands ? " COMMAND" : "") + (has_more ? " [OPTION...]" : "") + "\n";
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
