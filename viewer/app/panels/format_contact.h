#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "pillarfield/contact_quantities.h"

namespace pillarfield::viewer {

inline constexpr std::size_t kContactColumns = 9;

/// The head of a column of the table of contacts, and what it means.
struct ContactColumn {
  const char* head;    ///< "normal"
  const char* help;    ///< "normal force, N"
  const char* widest;  ///< words that are hardly ever exceeded
};
[[nodiscard]] const std::array<ContactColumn, kContactColumns>& contact_columns();

/// A line of the table: `name`, then as contact_columns(). Numbers have three digits; "–" stands
/// for what is not known or not there.
[[nodiscard]] std::array<std::string, kContactColumns> format_contact(
    const std::string& name, const ContactQuantities& contact);

}  // namespace pillarfield::viewer
