// pillarfield completion: scripts by which shells complete the command.

#include <fmt/format.h>

#include "cli/command.h"

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

/// A bash function; words that are not flags are file names.
std::string bash_script(const CLI::App& app) {
  std::string cases;
  for (const CLI::App* command : subcommands_of(app)) {
    cases += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), flags_of(*command));
  }
  return fmt::format(R"(_pillarfield() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} words
  case ${{COMP_WORDS[1]}} in
{}    *) words="{}{}" ;;
  esac
  if [[ $COMP_CWORD -gt 1 && $current != -* ]]; then words=; fi
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _pillarfield pillarfield
)",
                     cases, names_of_subcommands(app), flags_of(app));
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

std::string fish_script(const CLI::App& app) {
  std::string script;
  for (const CLI::App* command : subcommands_of(app)) {
    script += fish_line("__fish_use_subcommand", "-f -a " + command->get_name(),
                        command->get_description());
    const std::string condition = "__fish_seen_subcommand_from " + command->get_name();
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        script += fish_line(condition, "-l " + name, option->get_description());
      }
    }
  }
  return script;
}

}  // namespace

void add_completion(CLI::App& app, Work& work) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* const command = app.add_subcommand(
      "completion", "Print a completion script: source <(pillarfield completion bash)");
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([shell, &app, &work] {
    work = [shell, &app] {
      const std::string script = *shell == "fish"  ? fish_script(app)
                                 : *shell == "zsh" ? zsh_script(app)
                                                   : bash_script(app);
      fmt::print("{}", script);
    };
  });
}

}  // namespace pillarfield::cli
