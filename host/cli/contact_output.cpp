#include "cli/contact_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "pillarfield/error.h"

namespace pillarfield::cli {
namespace {

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return ending;
}

bool is_hdf5(const std::string& file) {
  const std::string ending = ending_of(file);
  return ending == ".h5" || ending == ".hdf5";
}

}  // namespace

void take_friction(const SolverPlan& plan, ContactOptions& contacts) {
  contacts.friction = plan.friction;
  contacts.noise_n = reading_noise_n(plan);
  contacts.hidden_n = hidden_normal_n(plan.skin);
}

void check(const ContactOutputOptions& options, const std::string& output) {
  if (options.file.empty()) return;
  check(options.contacts, "the command line");
  const bool same = name_same_file(options.file, output);
  if (same && !is_hdf5(output)) {
    throw Error(options.file, "forces and contacts cannot share this file",
                "give contacts a name of their own");
  }
  if (!same && is_hdf5(options.file)) {
    throw Error(options.file, "its ending names no table of contacts",
                fmt::format("end it in {}, or name the .h5 file of forces",
                            endings_of(OutputKind::contacts)));
  }
  static_cast<void>(planned_table(options, output));
}

std::optional<PlannedOutput> planned_table(const ContactOutputOptions& options,
                                           const std::string& output) {
  if (options.file.empty() || name_same_file(options.file, output)) return std::nullopt;
  return planned_contact_file(options.file);
}

void ask_for_contacts(const ContactOutputOptions& options, const std::string& output,
                      ForceFileInfo& forces) {
  if (!options.file.empty() && is_hdf5(output)) forces.contacts = options.contacts;
}

}  // namespace pillarfield::cli
