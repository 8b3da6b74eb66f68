// pillarfield_field_page DOCS: measures, and writes DOCS/field.md with its pictures.
// pillarfield_field_page --table tuning|judging [FILTER [SWEEPS]]: a line for each scene.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "report/field/scene_lines.h"

namespace pillarfield::report {
namespace {

int usage() {
  std::fputs(
      "usage: pillarfield_field_page DOCS\n"
      "       pillarfield_field_page --table tuning|judging [FILTER [SWEEPS]]\n",
      stderr);
  return 2;
}

int print_table(const std::vector<std::string>& words) {
  const std::string filter = words.size() > 2 ? words[2] : "";
  const int sweeps = words.size() > 3 ? std::atoi(words[3].c_str()) : FieldEvidence{}.sweeps;
  const bool tunes = words[1] == "tuning";
  if (!tunes && words[1] != "judging") return usage();
  auto scenes = tunes ? field_study::tuning(filter) : field_study::judging(filter);
  field_study::integrate(scenes);
  std::fputs(scene_lines(scenes, sweeps).c_str(), stdout);
  return 0;
}

int run(const std::vector<std::string>& words) {
  if (words.size() >= 2 && words.size() <= 4 && words[0] == "--table") return print_table(words);
  return usage();
}

}  // namespace
}  // namespace pillarfield::report

int main(int count, char** words) {
  try {
    return pillarfield::report::run({words + 1, words + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "pillarfield_field_page: %s\n", error.what());
    return 1;
  }
}
