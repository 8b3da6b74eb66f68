#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contacts/friction_belief.h"
#include "contacts/friction_evidence.h"
#include "contacts/pressure_regression.h"
#include "core/contact_identity.h"
#include "core/pillar_maths.h"
#include "core/silent_blocks.h"
#include "core/work_team.h"
#include "pillarfield/contact_map.h"
#include "pillarfield/force_field.h"
#include "pillarfield/solver_plan.h"

namespace pillarfield {

/// What is believed of a contact's friction.
struct ContactFriction {
  double median = 0;
  double spread = 0;  ///< standard deviation of its logarithm
};

/// The estimator `contact`: for each contact a posterior over its friction, carried from frame to
/// frame, and from it the normal forces of the pillars that readings leave ambiguous
/// (docs/derivations/contact.md). It runs on the host's threads, after the direct solve, and gives
/// the same bits with any number of them.
class ContactEstimator {
 public:
  explicit ContactEstimator(const SolverPlan& plan, std::size_t threads = 1,
                            const ContactParameters& parameters = {});

  /// Estimates the ambiguous pillars of the next frame, which the direct solve of the plan left.
  void resolve(ForceField& field);

  /// The same of planes of the plan's size; those from magnitude on may be null. Of idle blocks
  /// nothing is read.
  void resolve(const single_precision::Field& field, const SilentBlocks& idle = {});

  /// The contacts of the last frame, and what is believed of each.
  [[nodiscard]] const ContactMap& contacts() const { return map_; }
  [[nodiscard]] std::span<const ContactFriction> friction() const { return friction_; }

 private:
  /// Memory of one thread, kept from contact to contact.
  struct Workspace {
    std::vector<ShownRatio> ratios;
    std::vector<ShownRatio> bounds;
    std::vector<ShownRatio> predicted;
    std::vector<PressureRegression::Sample> samples;
    std::vector<std::uint32_t> ambiguous;  ///< sampled, by index in the frame
    std::vector<std::uint32_t> top;        ///< first row of the contact in each sampled column
    std::vector<std::uint32_t> bottom;     ///< and its last
    double peak_n = 0;  ///< the largest normal force that a sampled pillar may have

    void clear();
  };

  /// What its ambiguous pillars are estimated with.
  struct Contact {
    static constexpr std::size_t kNodes = 6;
    std::array<float, kNodes> nodes{};  ///< frictions of equal probability
    std::optional<PressureRegression> pressure;
    std::uint32_t first_row = 0;  ///< of the box about it
    std::uint32_t first_col = 0;
    std::uint32_t rows = 0;
    std::uint32_t cols = 0;
    std::uint32_t pillars = 0;
    bool any_ambiguous = false;

    /// Places in the regression: from the box's middle, about 1 at its farther edges.
    [[nodiscard]] double x_of(double col) const {
      return (col - first_col - 0.5 * (cols - 1)) / scale();
    }
    [[nodiscard]] double y_of(double row) const {
      return (row - first_row - 0.5 * (rows - 1)) / scale();
    }
    [[nodiscard]] double scale() const { return 0.5 * (rows > cols ? rows : cols) + 1; }
  };

  /// A side at which a contact ends: next to which pillar, and where from there (1, 0 or -1).
  struct Edge {
    std::uint32_t row;
    std::uint32_t col;
    int down;
    int right;
  };

  struct NormalEstimate {
    double normal;    ///< N
    double variance;  ///< N²
  };

  struct Batch;

  void match();
  void learn(const single_precision::Field& field, std::uint32_t number, Workspace& work);
  void measure(std::span<const ContactRun> runs, Contact& contact) const;
  void gather(const single_precision::Field& field, Contact& contact,
              std::span<const ContactRun> runs, Workspace& work) const;
  void ask(const single_precision::Field& field, const Contact& contact, std::uint32_t row,
           std::uint32_t col, Workspace& work) const;
  void add_edge(const single_precision::Field& field, const Contact& contact, const Edge& edge,
                double weight, Workspace& work) const;
  void add_ends_of_rows(const single_precision::Field& field, const Contact& contact,
                        std::span<const ContactRun> runs, double weight, Workspace& work) const;
  void add_ends_of_columns(const single_precision::Field& field, const Contact& contact,
                           std::span<const ContactRun> runs, double weight, Workspace& work) const;
  [[nodiscard]] std::optional<NormalEstimate> predicted(const Contact& contact, std::uint32_t index,
                                                        double high) const;
  [[nodiscard]] single_precision::Segment segment_of(const single_precision::Field& field,
                                                     std::uint32_t index) const;
  [[nodiscard]] double most_normal(const single_precision::Field& field, std::uint32_t index) const;
  [[nodiscard]] double deviation_of_ratio(double normal) const;
  void predict(const single_precision::Field& field, const Contact& contact, Workspace& work) const;
  void estimate(const single_precision::Field& field, std::uint32_t number) const;
  void write(const single_precision::Field& field, const Contact& contact, const Batch& batch,
             std::size_t i) const;

  ContactParameters parameters_;
  FrictionLikelihood likelihood_;
  FrictionBelief prior_;
  bool remember_;
  double pitch_mm_;
  double noise_n_;       ///< of a reading
  float segment_point_;  ///< where the direct solve has put ambiguous forces
  std::uint32_t rows_;
  std::uint32_t cols_;
  ContactMap map_;
  ContactTraces traces_;
  ContactTraces traces_before_;
  std::vector<FrictionBelief> beliefs_;
  std::vector<FrictionBelief> beliefs_before_;
  std::vector<Contact> contacts_;
  std::vector<ContactFriction> friction_;
  std::vector<Workspace> workspaces_;
  std::unique_ptr<WorkTeam> team_;
};

}  // namespace pillarfield
