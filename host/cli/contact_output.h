#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "pillarfield/contact_file.h"
#include "pillarfield/contact_tracker.h"
#include "pillarfield/force_file.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield::cli {

/// Which contacts are told of, and where, as far as the command line says.
struct ContactOutputOptions {
  std::string file;  ///< empty: nowhere
  ContactOptions contacts;
};

/// Takes what `plan` knows of friction, by --friction or by a scene, and of noise for contacts.
void take_friction(const SolverPlan& plan, ContactOptions& contacts);

/// Throws Error unless contacts can be written to where `options` says, or nothing is said.
/// `output` is the file of forces.
void check(const ContactOutputOptions& options, const std::string& output);

/// The table of contacts that the options ask for; none where the file of forces `output` is named.
[[nodiscard]] std::optional<PlannedOutput> planned_table(const ContactOutputOptions& options,
                                                         const std::string& output);

/// Lets the file of forces hold contacts where `options` asks for any and it can.
void ask_for_contacts(const ContactOutputOptions& options, const std::string& output,
                      ForceFileInfo& forces);

}  // namespace pillarfield::cli
