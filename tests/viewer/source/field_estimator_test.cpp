// Scenes with the estimator `contact` in the viewer.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "contacts/estimator/contact_estimator.h"
#include "pillarfield/host_solve.h"
#include "pillarfield/scene.h"
#include "tests/io/sample_files.h"
#include "tests/viewer/source/solved_scene.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {
namespace {

using io_test::has_all;
using io_test::TemporaryDirectory;
using io_test::write_bytes;

/// A sliding ball, solved by the estimator `contact`, with further lines of [solver].
std::string sliding_scene(const std::string& solver_lines) {
  return "[skin]\nsize_mm = [30, 30]\n[solver]\nestimator = \"contact\"\n" + solver_lines +
         "[sensor]\nnoise_counts = 0.5\n[time]\nframes = 6\n"
         "[[contact]]\nshape = \"sphere\"\nmotion = \"slide\"\ncontact_radius_mm = 8\n"
         "friction = 1.8\ndirection_deg = 0\nposition_mm = [0, 0]\nload_n = 30\n";
}

TEST(SceneProducer, SolvesWithTheContactEstimatorAndItsUncertainty) {
  const auto path = std::filesystem::path(PILLARFIELD_SCENES) / "ambiguous_contacts.toml";
  const Simulator simulator(load_scene(path));
  const SolverPlan plan = plan_of(simulator);
  ASSERT_EQ(plan.estimator, Estimator::contact);
  FrameBuffer frame(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  const auto producer = open_producer(path, {.most_frames = 2});
  EXPECT_TRUE(has_all(producer->info().solver, {"contact on "}));
  EXPECT_TRUE(producer->info().has_uncertainty);
  const ShownField field = producer->produce(1);
  simulator.render(1, frame, truth);
  expect_same_forces(field.forces, solve_on_host(plan, frame.view()).view());
  EXPECT_FALSE(field.forces.uncertainty[Uncertainty::theta_low].empty());
  const auto resolved = std::ranges::count_if(
      field.forces.status, [](std::uint8_t s) { return (s & status::kFromNeighbours) != 0; });
  EXPECT_GT(resolved, 50);
  const ShownContacts contacts = producer->contacts_of(field);
  ASSERT_EQ(contacts.found.contacts.size(), 3U);
  std::uint64_t from_contact = 0;
  for (const auto& contact : contacts.found.contacts) from_contact += contact.quantities.resolved;
  EXPECT_EQ(from_contact, static_cast<std::uint64_t>(resolved));
}

TEST(SceneProducer, ContactsHaveTheFrictionOfTheScene) {
  const TemporaryDirectory directory;
  for (const bool given : {false, true}) {
    const auto path = directory / (given ? "given.toml" : "observed.toml");
    write_bytes(path, sliding_scene(given ? "friction = 2.5\n" : ""));
    const auto producer = open_producer(path, {.most_frames = 1});
    const ShownContacts contacts = producer->contacts_of(producer->produce(0));
    ASSERT_EQ(contacts.found.contacts.size(), 1U);
    const ContactQuantities& found = contacts.found.contacts[0].quantities;
    EXPECT_EQ(found.friction_source == FrictionSource::given, given);
    EXPECT_EQ(found.friction == 2.5, given);
  }
}

/// The frames of a scene solved in order in C++, with the prior carried over.
std::vector<ForceField> solved_in_order(const std::filesystem::path& path, std::uint64_t frames) {
  const Simulator simulator(load_scene(path));
  SolverPlan plan = plan_of(simulator);
  ContactEstimator estimator(plan);
  plan.estimator = Estimator::direct;
  FrameBuffer raw(plan.sensel_type, plan.skin.rows, plan.skin.cols);
  ForceField truth(plan.skin.pillar_rows(), plan.skin.pillar_cols());
  std::vector<ForceField> solved;
  for (std::uint64_t index = 0; index < frames; ++index) {
    simulator.render(index, raw, truth);
    solved.push_back(solve_on_host(plan, raw.view()));
    estimator.resolve(solved.back());
  }
  return solved;
}

/// A ball with growing shear: the friction observed in frame 4 sharpens frame 5.
constexpr const char* kGrowingShear =
    "[skin]\nsize_mm = [30, 30]\n[solver]\nestimator = \"contact\"\n"
    "[sensor]\nnoise_counts = 0.3\n[time]\nframes = 6\n"
    "[[contact]]\nshape = \"sphere\"\nmotion = \"press\"\ncontact_radius_mm = 8\n"
    "path = [{ time_s = 0, position_mm = [0, 0], load_n = 30 },\n"
    "        { time_s = 0.05, position_mm = [0, 0], load_n = 3 }]\n"
    "[[contact]]\nshape = \"sphere\"\nmotion = \"slide\"\ncontact_radius_mm = 8\n"
    "friction = 1.9\ndirection_deg = 0\n"
    "path = [{ time_s = 0, position_mm = [0, 0], load_n = 3 },\n"
    "        { time_s = 0.05, position_mm = [0, 0], load_n = 30 }]\n";

class FramesInOrder : public testing::Test {
 protected:
  FramesInOrder() { write_bytes(path_, kGrowingShear); }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "growing.toml";
};

TEST_F(FramesInOrder, CarryThePriorOverWhilePlayed) {
  const std::vector<ForceField> expected = solved_in_order(path_, 4);
  for (const Memory memory : {Memory::automatic, Memory::staged}) {
    const auto producer = open_producer(path_, {.memory = memory});
    for (std::uint64_t index = 0; index < expected.size(); ++index) {
      expect_same_forces(producer->produce(index).forces, expected[index].view());
    }
  }
}

TEST_F(FramesInOrder, HaveNoPriorAfterAJump) {
  const auto producer = open_producer(path_, {});
  ASSERT_EQ(producer->info().notes.size(), 1U);
  EXPECT_TRUE(has_all(producer->info().notes[0], {"jumped to", "solved alone"}));
  const ForceField alone = copy_of(producer->produce(5).forces);
  for (const std::uint64_t before : {0U, 3U, 5U}) {
    static_cast<void>(producer->produce(before));
    expect_same_forces(producer->produce(5).forces, alone.view());
  }
  static_cast<void>(producer->produce(4));
  EXPECT_FALSE(std::ranges::equal(producer->produce(5).forces.normal, alone.normal));
}

TEST_F(FramesInOrder, AreForgottenInTheLastFreeSlot) {
  const auto producer = open_producer(path_, {});
  std::vector<ShownField> shown = {producer->produce(3)};
  const ForceField alone = copy_of(shown[0].forces);
  while (shown.size() < FieldProducer::kMostShown) {
    shown.push_back(producer->produce(3));
    expect_same_forces(shown.back().forces, alone.view());
  }
  expect_same_forces(shown[0].forces, alone.view());
}

}  // namespace
}  // namespace pillarfield::viewer
