#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/pillar_maths.h"
#include "core/silent_blocks.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// Of a contact at least one pillar in so many must be open for its evidence to be heard: fewer are
/// lone pillars at its edge, which bear little, and all of the contact would be searched for them.
inline constexpr std::uint32_t kLeastOpenShare = 64;

/// What the field estimator has to do in one frame: which contacts are worth a look, where in the
/// scratch memory each has its place, and which pillars stay alone. Memory is kept from frame to
/// frame.
class FieldWork {
 public:
  explicit FieldWork(const SolverPlan& plan);

  /// Looks at the status bytes [rows, cols] that the direct solve left, but for those of blocks
  /// that are known to be silent.
  void find(std::span<const std::uint8_t> status, const SilentBlocks& silent = {});

  [[nodiscard]] const single_precision::FieldSettings& settings() const { return settings_; }
  [[nodiscard]] const ContactMap& map() const { return map_; }
  /// Contacts that have both open and resolved pillars.
  [[nodiscard]] const std::vector<single_precision::Tile>& tiles() const { return tiles_; }
  /// Indices of the open pillars of all others.
  [[nodiscard]] const std::vector<std::uint32_t>& alone() const { return alone_; }
  [[nodiscard]] std::size_t cells() const { return cells_; }  ///< scratch cells of all tiles
  [[nodiscard]] std::size_t lines() const { return lines_; }  ///< records of lines of all tiles

 private:
  /// What a contact is made of.
  struct Summary {
    std::uint32_t pillars = 0;
    std::uint32_t open = 0;
    std::uint32_t first_col = ~std::uint32_t{0};
    std::uint32_t end_col = 0;
  };

  [[nodiscard]] std::span<const std::uint8_t> status_of(const ContactRun& run,
                                                        std::span<const std::uint8_t> status) const;
  /// Whether enough pillars of a contact have forces that their own readings determine.
  [[nodiscard]] bool has_evidence(std::span<const ContactRun> runs,
                                  std::span<const std::uint8_t> status) const;
  Summary summarise(std::span<const ContactRun> runs, std::span<const std::uint8_t> status);
  /// Open pillars of a run whose first one has this index.
  void add_alone(std::span<const std::uint8_t> status, std::size_t first);
  void add_contact(std::uint32_t contact, std::span<const std::uint8_t> status);

  std::uint32_t rows_;
  std::uint32_t cols_;
  single_precision::FieldSettings settings_;
  ContactMap map_;
  std::vector<single_precision::Tile> tiles_;
  std::vector<std::uint32_t> alone_;
  std::vector<ContactRun> open_runs_;  ///< of the contact at hand, those with open pillars
  std::size_t cells_ = 0;
  std::size_t lines_ = 0;
};

}  // namespace pillarfield
