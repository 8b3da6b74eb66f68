#include <fmt/format.h>

#include "cli/options/help.h"

namespace pillarfield::cli {

std::string completion_words(const CLI::App& app, std::span<const std::string> words) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    for (const CLI::App* command : app.get_subcommands({})) {
      if (command->get_name() == words[i]) return completion_words(*command, words.subspan(i + 1));
    }
  }
  std::string lines;
  for (const CLI::App* command : app.get_subcommands({})) {
    lines += fmt::format("{}\t{}\n", command->get_name(), command->get_description());
  }
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      lines += fmt::format("--{}\t{}\n", name, option->get_description());
    }
  }
  return lines;
}

std::string completion_script(const std::string& shell) {
  if (shell == "fish") {
    return "complete -c pillarfield -a '(pillarfield completion words -- "
           "(commandline -opc)[2..])'\n";
  }
  if (shell == "zsh") {
    return R"(#compdef pillarfield
_pillarfield() {
  local -a commands options
  local line
  for line in "${(@f)$(pillarfield completion words -- "${(@)words[2,CURRENT-1]}")}"; do
    line=${line/$'\t'/:}
    [[ $line == -* ]] && options+=("$line") || commands+=("$line")
  done
  if [[ ${words[CURRENT]} == -* ]]; then
    _describe -o option options
  else
    (( $#commands )) && _describe command commands
    _files
  fi
}
if [[ ${funcstack[1]} == _pillarfield ]]; then
  _pillarfield "$@"
else
  compdef _pillarfield pillarfield
fi
)";
  }
  return R"(_pillarfield() {
  local current=${COMP_WORDS[COMP_CWORD]} words
  words=$(pillarfield completion words -- "${COMP_WORDS[@]:1:COMP_CWORD-1}" | cut -f1)
  [[ $current == -* ]] || words=$(grep -v '^-' <<<"$words")
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}
complete -o default -F _pillarfield pillarfield
)";
}

}  // namespace pillarfield::cli
