#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/friction.h"

namespace pillarfield {

struct SilentBlocks;  // solve/silent_blocks.h

/// Loaded pillars of one row, side by side.
struct ContactRun {
  std::uint32_t row = 0;
  std::uint32_t first = 0;    ///< column
  std::uint32_t end = 0;      ///< one past the last column
  std::uint32_t contact = 0;  ///< which contact they belong to
};

/// The contacts of a frame: connected components of its loaded pillars, which are those with a
/// usable sensel. Pillars that touch at a side or at a corner are connected.
///
/// Contacts are numbered from 0 in the order in which their first pillars come row by row, so the
/// numbers depend on the frame alone. Memory is kept from frame to frame.
class ContactMap {
 public:
  /// Finds the contacts of a frame's status bytes [rows, cols]. Linear in its pillars. Throws Error
  /// where the span has another size.
  void find(std::span<const std::uint8_t> status, std::uint32_t rows, std::uint32_t cols);

  /// The same where it is known which blocks have no loaded pillar: their status is not read.
  void find(std::span<const std::uint8_t> status, std::uint32_t rows, std::uint32_t cols,
            const SilentBlocks& silent);

  [[nodiscard]] std::uint32_t contacts() const {
    return static_cast<std::uint32_t>(starts_.empty() ? 0 : starts_.size() - 1);
  }
  /// All runs, contact by contact; those of a contact row by row from the left.
  [[nodiscard]] std::span<const ContactRun> runs() const { return runs_; }
  [[nodiscard]] std::span<const ContactRun> runs(std::uint32_t contact) const {
    return std::span(runs_).subspan(starts_[contact], starts_[contact + 1] - starts_[contact]);
  }

  /// The same runs row by row from the left.
  [[nodiscard]] std::span<const ContactRun> runs_by_row() const { return found_; }

 private:
  void find_runs(std::span<const std::uint8_t> status, std::uint32_t cols);
  void number_contacts();
  void sort_runs();

  std::vector<ContactRun> awake_;  ///< where there may be loaded pillars, row by row
  std::vector<ContactRun> runs_;
  std::vector<std::size_t> starts_;     ///< first run of each contact, and one past the last
  std::vector<ContactRun> found_;       ///< row by row
  std::vector<std::uint32_t> parents_;  ///< a run before each in its contact, or itself
  std::vector<std::size_t> next_;       ///< of each contact, where its next run goes
};

/// The contacts of a frame that were found already, and what is believed of the friction of each.
struct FoundContacts {
  const ContactMap* map = nullptr;            ///< null: they were not looked for
  std::span<const ContactFriction> friction;  ///< by number; empty where it was not asked for
};

}  // namespace pillarfield
