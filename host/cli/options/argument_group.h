// Adds options to a command under one heading, with checks whose messages name the allowed values.

#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/named.h"

namespace pillarfield::cli {

inline constexpr double kAny = std::numeric_limits<double>::max();

/// Accepts a finite number in [least, most]; CLI::Range also accepts NaN.
CLI::Validator number_in(double least, double most);

/// Accepts a whole number in [least, most] in decimal digits. CLI::Range reads "-1" as a large
/// number, too many digits as the largest, and "010" as eight.
CLI::Validator whole_number_in(std::uint64_t least, std::uint64_t most);

/// Accepts one of `words`, and `hidden`, which messages do not name.
CLI::Validator one_of(const std::vector<std::string>& words, const std::string& hidden = "");

/// Refuses "-".
CLI::Validator no_stream();

/// Adds arguments under one heading of the help.
class Group {
 public:
  Group(CLI::App* command, std::string heading) : command_(command), heading_(std::move(heading)) {}

  template <class Target>
  CLI::Option* text(const std::string& names, Target& target, const char* kind,
                    const std::string& description) {
    return command_->add_option(names, target, description)
        ->type_name(kind)
        ->group(heading_)
        ->check(no_stream());
  }

  template <class Target>
  void file(const std::string& name, Target& target, const char* description) {
    text(name, target, "FILE", description)->required();
  }

  template <class Target>
  CLI::Option* number(const std::string& names, Target& target, const char* unit,
                      const char* description, double least = -kAny, double most = kAny) {
    return text(names, target, unit, description)->check(number_in(least, most));
  }

  template <class Target>
  CLI::Option* whole(const std::string& names, Target& target, const char* unit,
                     const char* description, std::uint64_t least, std::uint64_t most) {
    return text(names, target, unit, description)->check(whole_number_in(least, most));
  }

  CLI::Option* word(const std::string& name, std::string& target,
                    const std::vector<std::string>& words, const char* description) {
    return command_->add_option(name, target, description)
        ->type_name(fmt::format("{}", fmt::join(words, "|")))
        ->check(one_of(words))
        ->group(heading_);
  }

  /// Adds an option that sets `target` to the value of a word.
  template <class Value, class Target>
  CLI::Option* choice(const std::string& name, Target& target,
                      const std::vector<std::pair<std::string, Value>>& choices,
                      const char* description) {
    std::vector<std::string> words(choices.size());
    std::ranges::transform(choices, words.begin(), &std::pair<std::string, Value>::first);
    const auto assign = [=, &target](const std::string& given) {
      target = std::ranges::find(choices, given, &std::pair<std::string, Value>::first)->second;
    };
    return command_->add_option_function<std::string>(name, assign, description)
        ->type_name(fmt::format("{}", fmt::join(words, "|")))
        ->check(one_of(words))
        ->group(heading_);
  }

  /// Adds an option that sets `target` to the value of a name of a table.
  template <class Value, std::size_t count, class Target>
  CLI::Option* choice(const std::string& name, Target& target,
                      const std::array<Named<Value>, count>& table, const char* description) {
    std::vector<std::pair<std::string, Value>> choices;
    choices.reserve(count);
    for (const Named<Value>& row : table) choices.emplace_back(row.name, row.value);
    return choice<Value>(name, target, choices, description);
  }

  CLI::Option* flag_callback(const std::string& name, const std::function<void()>& call,
                             const char* description) {
    return command_->add_flag_callback(name, call, description)->group(heading_);
  }

  CLI::Option* flag(const std::string& names, bool& target, const char* description) {
    return command_->add_flag(names, target, description)->group(heading_);
  }

 private:
  CLI::App* command_;
  std::string heading_;
};

}  // namespace pillarfield::cli
