// Contacts of simulated scenes, solved and tracked.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "pillarfield/contact_tracker.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/simulator.h"

namespace pillarfield {
namespace {

/// A scene, solved and tracked frame by frame.
class SolvedScene {
 public:
  explicit SolvedScene(const std::string& name)
      : simulator_(load_scene(std::string(PILLARFIELD_SCENES) + "/" + name)),
        raw_(simulator_.sensel_type(), scene().skin.rows, scene().skin.cols),
        truth_(scene().skin.pillar_rows(), scene().skin.pillar_cols()),
        tracker_(scene().skin.pillar_pitch_mm(), {.minimum_pillars = 5}) {
    plan_.skin = scene().skin;
    plan_.sensel_type = simulator_.sensel_type();
    plan_.calibration = simulator_.calibration();
    set_solver(plan_, scene());
    plan_.estimator = Estimator::direct;
    plan_.angles = false;
    plan_.uncertainty = false;
  }

  [[nodiscard]] const Scene& scene() const { return simulator_.scene(); }

  const FrameContacts& frame(std::uint64_t index) {
    simulator_.render(index, raw_, truth_);
    const ForceField solved = solve_on_host(plan_, raw_.view());
    return tracker_.update(solved.view(), simulator_.time_of(index));
  }

  /// Load and place of a contact of the scene.
  [[nodiscard]] ContactKey key(std::size_t contact, double time_s) const {
    const auto& path = std::get<std::vector<ClosedFormContact>>(scene().load).at(contact).path;
    for (std::size_t i = 1; i < path.size(); ++i) {
      if (time_s > path[i].time_s) continue;
      const ContactKey& a = path[i - 1];
      const ContactKey& b = path[i];
      const double part = (time_s - a.time_s) / (b.time_s - a.time_s);
      return {time_s, a.x_mm + part * (b.x_mm - a.x_mm), a.y_mm + part * (b.y_mm - a.y_mm),
              a.load_n + part * (b.load_n - a.load_n)};
    }
    return path.back();
  }

 private:
  Simulator simulator_;
  SolverPlan plan_;
  FrameBuffer raw_;
  ForceField truth_;
  ContactTracker tracker_;
};

/// Noise of half a count, rounding, and a threshold above the edge's readings.
TEST(Scenes, SeveralContactsBearTheirLoads) {
  SolvedScene scene("touch/several_contacts.toml");
  std::set<std::uint64_t> ids;
  for (std::uint64_t index = 20; index < 95; index += 5) {
    const FrameContacts& frame = scene.frame(index);
    ASSERT_EQ(frame.contacts.size(), 3) << index;
    double sum_n = 0;
    for (const TrackedContact& tracked : frame.contacts) {
      ids.insert(tracked.track_id);
      const ContactQuantities& contact = tracked.quantities;
      const PatchPlace& at = contact.centre_of_pressure;
      const std::size_t which = at.y_mm > 0 ? 0 : at.x_mm < 0 ? 1 : 2;
      const ContactKey key = scene.key(which, frame.time_s);
      EXPECT_NEAR(contact.normal_n, key.load_n, 0.01 * key.load_n + 0.1);
      EXPECT_NEAR(at.x_mm, key.x_mm, 0.1);
      EXPECT_NEAR(at.y_mm, key.y_mm, 0.1);
      sum_n += key.load_n;
      const double friction[] = {0.6, 1.0, 0.8};
      ASSERT_TRUE(contact.friction.has_value()) << index << " " << which;
      // One slides, which its way shows; one slips in part, always alike; a punch spins.
      const bool shown = which == 2 || (which == 0 && index >= 45);
      ASSERT_EQ(contact.friction_deviation.has_value(), shown) << index << " " << which;
      EXPECT_LT(*contact.friction, friction[which] + 0.03);
      if (!contact.friction_deviation) continue;
      EXPECT_NEAR(*contact.friction, friction[which], 0.03);
      EXPECT_NEAR(*contact.slip_margin, which == 2 ? 1 : 0, 0.05);
      EXPECT_EQ(contact.slip, SlipState::sliding) << index;
    }
    EXPECT_NEAR(frame.total.normal_n, sum_n, 0.01 * sum_n);
  }
  EXPECT_EQ(ids.size(), 3);
}

/// A spin has no resultant shear, but torque and slip.
TEST(Scenes, SpinSlidesThoughItsShearCancels) {
  SolvedScene scene("touch/spin.toml");
  const ContactQuantities contact = scene.frame(0).contacts.at(0).quantities;
  EXPECT_EQ(contact.slip, SlipState::sliding);
  EXPECT_NEAR(*contact.friction, 1.6, 0.03);
  EXPECT_GT(*contact.slip_margin, 0.99);
  // Under a Hertz pressure, 3 pi / 16 times mu P a; clockwise.
  EXPECT_NEAR(contact.torque_nmm, -3 * M_PI / 16 * 1.6 * 60 * 16, 0.1 * 900);
}

/// A frame alone does not tell it from a contact that sticks.
TEST(Scenes, PartialSlipBoundsTheFrictionFromBelow) {
  SolvedScene scene("touch/partial_slip.toml");
  const ContactQuantities contact = scene.frame(0).contacts.at(0).quantities;
  EXPECT_EQ(contact.friction_source, FrictionSource::at_least);
  EXPECT_GT(contact.friction.value(), 0.8);
  EXPECT_LT(*contact.friction, 1.6);
  EXPECT_FALSE(contact.friction_deviation);
}

}  // namespace
}  // namespace pillarfield
