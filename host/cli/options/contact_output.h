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

/// The output of contacts.
struct ContactOutputOptions {
  std::string file;  ///< empty: none
  ContactOptions contacts;
};

/// Copies friction and noise of `plan` to the options of contacts.
void set_friction(const SolverPlan& plan, ContactOptions& contacts);

/// Throws Error where contacts cannot be written as `options` name them beside the forces in
/// `output`.
void check(const ContactOutputOptions& options, const std::string& output);

/// Returns the table of contacts; none where the options name no file or the force file `output`.
[[nodiscard]] std::optional<PlannedOutput> planned_table(const ContactOutputOptions& options,
                                                         const std::string& output);

/// Adds contacts to the force file `output` where it is HDF5 and `options` name a file.
void set_contacts(const ContactOutputOptions& options, const std::string& output,
                  ForceFileInfo& forces);

}  // namespace pillarfield::cli
