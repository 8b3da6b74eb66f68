#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pillarfield/friction.h"

namespace pillarfield {

/// @cond internal
struct IdleBlocks;  // solve/idle_blocks.h
/// @endcond

/// A run of adjacent loaded pillars in one row.
struct ContactRun {
  std::uint32_t row = 0;
  std::uint32_t first = 0;    ///< column
  std::uint32_t end = 0;      ///< one past the last column
  std::uint32_t contact = 0;  ///< label of its contact
};

/// The contacts of a frame: connected components (sides and corners) of its loaded pillars, which
/// have a usable sensel. A gap of one or two missing or saturated pillars without one, such as a
/// dead column, does not part a contact and does not belong to it.
/// Labels count from 0 in the order of first pillars, row by row, so they depend on the frame
/// alone. Reuse the object from frame to frame: it keeps its memory.
class ContactLabels {
 public:
  /// Labels the contacts of a frame from its status bytes, [rows, cols], in time linear in pillars.
  /// Throws Error if `status` has another size.
  void find(std::span<const std::uint8_t> status, std::uint32_t rows, std::uint32_t cols);

  /// @cond internal Labels the contacts without reading the status of idle blocks.
  void find(std::span<const std::uint8_t> status, std::uint32_t rows, std::uint32_t cols,
            const IdleBlocks& idle);
  /// @endcond

  /// The number of contacts.
  [[nodiscard]] std::uint32_t contacts() const {
    return static_cast<std::uint32_t>(starts_.empty() ? 0 : starts_.size() - 1);
  }
  /// All runs, by label; within a contact row by row from the left.
  [[nodiscard]] std::span<const ContactRun> runs() const { return runs_; }
  /// The runs of one contact.
  [[nodiscard]] std::span<const ContactRun> runs(std::uint32_t contact) const {
    return std::span(runs_).subspan(starts_[contact], starts_[contact + 1] - starts_[contact]);
  }

  /// All runs, row by row from the left.
  [[nodiscard]] std::span<const ContactRun> runs_by_row() const { return found_; }

 private:
  void find_runs(std::span<const std::uint8_t> status, std::uint32_t cols);
  void label_contacts();
  void sort_runs();

  std::vector<ContactRun> active_;  ///< runs that may hold loaded pillars, row by row
  std::vector<ContactRun> runs_;
  std::vector<std::size_t> starts_;     ///< first run of each contact, and one past the last
  std::vector<ContactRun> found_;       ///< row by row
  std::vector<std::uint32_t> parents_;  ///< an earlier run of the same contact, or the run itself
  std::vector<std::size_t> next_;       ///< index of the next run of each contact
};

/// A view of the contacts of a frame as a Processor found them.
struct FoundContacts {
  const ContactLabels* labels = nullptr;      ///< null: the plan finds no contacts
  std::span<const ContactFriction> friction;  ///< by label; empty if it was not estimated
  /// @cond internal Blocks without a loaded pillar; null: unknown.
  const IdleBlocks* idle = nullptr;
  /// @endcond
};

}  // namespace pillarfield
