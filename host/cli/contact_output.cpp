#include "cli/contact_output.h"

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
                "end it in .csv or .json, or name the .h5 file of forces");
  }
  static_cast<void>(planned_table(options, output));
}

std::optional<PlannedOutput> planned_table(const ContactOutputOptions& options,
                                           const std::string& output) {
  if (options.file.empty() || name_same_file(options.file, output)) return std::nullopt;
  return PlannedOutput{options.file, kind_of_contact_file(options.file)};
}

void ask_for_contacts(const ContactOutputOptions& options, const std::string& output,
                      ForceFileInfo& forces) {
  if (!options.file.empty() && is_hdf5(output)) forces.contacts = options.contacts;
}

ContactOutput::ContactOutput(const ContactOutputOptions& options, const ForceFileInfo& forces,
                             const std::string& output, Replace replace)
    : tracker_(forces.pillar_pitch_mm, options.contacts),
      in_force_file_(forces.contacts.has_value()) {
  if (!planned_table(options, output)) return;
  table_ = create_contact_sink(options.file,
                               {forces.pillar_pitch_mm, forces.source, options.contacts}, replace);
}

void ContactOutput::append(const ForceFieldView& forces, const FoundContacts& found, double time_s,
                           ForceSink& sink) {
  const FrameContacts& frame = tracker_.update(forces, time_s, found);
  if (in_force_file_) sink.append_contacts(frame);
  if (table_) table_->append(frame);
  most_at_once_ = std::max(most_at_once_, frame.contacts.size());
  for (const TrackedContact& contact : frame.contacts) contacts_ = std::max(contacts_, contact.id);
}

void ContactOutput::finish() {
  if (table_) table_->finish();
}

}  // namespace pillarfield::cli
