#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

namespace pillarfield::cli {

/// Adds an option that takes one of several words and sets `target`, which must outlive the
/// command, to the value that the word stands for.
template <class Value, class Target>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Target& target,
                        const std::map<std::string, Value>& choices,
                        const std::string& description) {
  std::vector<std::string> words;
  words.reserve(choices.size());
  for (const auto& [word, value] : choices) words.push_back(word);
  const auto take = [&target, choices](const std::string& word) { target = choices.at(word); };
  return command.add_option_function<std::string>(name, take, description)
      ->check(CLI::IsMember(words));
}

}  // namespace pillarfield::cli
