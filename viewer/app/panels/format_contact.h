#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "pillarfield/contact_quantities.h"

namespace pillarfield::viewer {

inline constexpr std::size_t kContactColumns = 9;

/// A column of the table of contacts.
struct ContactColumn {
  const char* head;    ///< "normal"
  const char* help;    ///< "normal force, N"
  const char* widest;  ///< sample text that sets the width
};
[[nodiscard]] const std::array<ContactColumn, kContactColumns>& contact_columns();

/// A row of the table: `name`, then contact_columns(), numbers with three digits; "–" for missing
/// values.
[[nodiscard]] std::array<std::string, kContactColumns> format_contact(
    const std::string& name, const ContactQuantities& contact);

}  // namespace pillarfield::viewer
