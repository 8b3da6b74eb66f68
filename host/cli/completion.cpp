// pillarfield completion: scripts by which shells complete the command.

#include "cli/completion.h"

#include <fmt/format.h>

namespace pillarfield::cli {
namespace {

/// The flags of a command, "--output -o ...", as one line of words.
std::string flags_of(const CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) words += "--" + name + " ";
    for (const std::string& name : option->get_snames()) words += "-" + name + " ";
  }
  return words;
}

std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

std::string names_of_subcommands(const CLI::App& app) {
  std::string words;
  for (const CLI::App* command : subcommands_of(app)) words += command->get_name() + " ";
  return words;
}

/// Cases of a shell's `case` for what stands before the word to complete: those of the subcommands
/// first, for the shell takes the first that fits. `words` is how `app` is called.
std::string bash_cases(const CLI::App& app, const std::string& words) {
  std::string cases;
  for (const CLI::App* command : subcommands_of(app)) {
    const std::string separator = words.empty() ? "" : " ";
    cases += bash_cases(*command, words + separator + command->get_name());
  }
  return cases + fmt::format("    '{}'*) flags=\"{}\" names=\"{}\" ;;\n", words, flags_of(app),
                             names_of_subcommands(app));
}

/// A bash function; words that are neither flags nor subcommands are file names.
std::string bash_script(const CLI::App& app) {
  return fmt::format(R"(_pillarfield() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} flags names
  case "${{COMP_WORDS[*]:1:COMP_CWORD-1}}" in
{}  esac
  if [[ $current == -* ]]; then names=$flags; fi
  COMPREPLY=($(compgen -W "$names" -- "$current"))
}}
complete -o default -F _pillarfield pillarfield
)",
                     bash_cases(app, ""));
}

std::string zsh_script(const CLI::App& app) {
  return "autoload -U +X bashcompinit && bashcompinit\n" + bash_script(app);
}

/// One line for a word of a command; `condition` says where it may stand.
std::string fish_line(const std::string& condition, const std::string& word,
                      const std::string& description) {
  std::string quoted;
  for (const char character : description) {
    if (character == '\'' || character == '\\') quoted += '\\';
    quoted += character;
  }
  return fmt::format("complete -c pillarfield -n '{}' {} -d '{}'\n", condition, word, quoted);
}

/// The lines of all subcommands of `app`; `called` is the condition that it is the one called, and
/// empty for the program itself.
std::string fish_lines(const CLI::App& app, const std::string& called) {
  const std::string none_yet = called.empty()
                                   ? "__fish_use_subcommand"
                                   : fmt::format("{}; and not __fish_seen_subcommand_from {}",
                                                 called, names_of_subcommands(app));
  std::string lines;
  for (const CLI::App* command : subcommands_of(app)) {
    lines += fish_line(none_yet, "-f -a " + command->get_name(), command->get_description());
    const std::string condition = fmt::format("{}{}__fish_seen_subcommand_from {}", called,
                                              called.empty() ? "" : "; and ", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        lines += fish_line(condition, "-l " + name, option->get_description());
      }
    }
    lines += fish_lines(*command, condition);
  }
  return lines;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  if (shell == "fish") return fish_lines(app, "");
  return shell == "zsh" ? zsh_script(app) : bash_script(app);
}

}  // namespace pillarfield::cli
