#pragma once

#include <filesystem>
#include <string>

/// docs/accuracy.md, made from measurements. A section measures one thing, draws its pictures, and
/// returns its text: Markdown that begins with a heading of level 2. What it measures depends on
/// nothing but the code, so that two runs on one computer give the same text.
namespace pillarfield::report {

struct Context {
  std::filesystem::path docs;  ///< pictures go to docs / "pictures/accuracy"
};

[[nodiscard]] std::string regions_section(const Context& context);
[[nodiscard]] std::string errata_section(const Context& context);
[[nodiscard]] std::string hard_cases_section(const Context& context);
[[nodiscard]] std::string bound_section(const Context& context);
[[nodiscard]] std::string coverage_section(const Context& context);
[[nodiscard]] std::string testbed_section(const Context& context);
[[nodiscard]] std::string small_forces_section(const Context& context);

}  // namespace pillarfield::report
