// The program of a plan: its stages, constants and files.

#include "device/kernel_source.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "pillarfield/error.h"
#include "pillarfield/processor.h"
#include "pillarfield/tuning.h"
#include "random_plan.h"

namespace pillarfield {
namespace {

/// The value of a macro in a program's first lines, or "(none)" where it is not defined.
std::string macro(const std::string& program, const std::string& name) {
  const std::string source = program.substr(0, program.find("#line"));
  const std::string definition = "\n#define " + name + " ";
  const std::size_t start = ("\n" + source).find(definition);
  if (start == std::string::npos) return "(none)";
  const std::size_t value = start + definition.size() - 1;
  return source.substr(value, source.find('\n', value) - value);
}

TEST(KernelSource, ABarePlanHasNoStageItDoesNotNeed) {
  const SolverPlan plan = bare_plan(8, 32, SenselType::u8);
  const std::vector<std::string> expected = {"load", "classify", "direct_solve", "store"};
  EXPECT_EQ(kernel_stages(plan), expected);
  const std::string source = kernel_source(plan, 16);
  EXPECT_EQ(macro(source, "PF_LANES"), "16");
  EXPECT_EQ(macro(source, "PF_SENSEL"), "uchar");
  for (const char* stage : {"PF_RANGE", "PF_SATURATION", "PF_TARE", "PF_GAIN", "PF_DEAD_ZONE",
                            "PF_MASK", "PF_PARITY_TEST", "PF_ANGLES", "PF_PAPER", "PF_UNCERTAINTY",
                            "PF_NOISE", "PF_POWER_LAW", "PF_BASELINE"}) {
    EXPECT_EQ(macro(source, stage), "(none)") << stage;
  }
}

TEST(KernelSource, HasNoConstantThatIsNotFinite) {
  SolverPlan plan = bare_plan(8, 32, SenselType::u8);
  plan.skin.counts_per_newton = 0;
  EXPECT_THROW(static_cast<void>(kernel_source(plan, 16)), Error);
}

TEST(KernelSource, EveryOptionOfAPlanIsAStage) {
  SolverPlan plan = full_plan(8, 8, SenselType::f32, 1);
  plan.angles = true;
  plan.uncertainty = true;
  plan.baseline_rate = 0.1;
  plan.skin.power_law = PowerLaw{0.9, 50};
  const std::vector<std::string> expected = {"load",           "reject_out_of_range",
                                             "mask",           "saturation",
                                             "tare",           "gain",
                                             "power_law",      "classify",
                                             "dead_zone",      "direct_solve",
                                             "parity_test",    "angles",
                                             "uncertainty",    "store",
                                             "follow_baseline"};
  EXPECT_EQ(kernel_stages(plan), expected);
}

TEST(KernelSource, TheMarginIsFiveDeviationsOfThreeReadings) {
  SolverPlan plan = bare_plan(8, 8, SenselType::f32);
  const auto margin = [&] {
    return std::strtof(macro(kernel_source(plan, 1), "PF_VALUE_margin").c_str(), nullptr);
  };
  EXPECT_EQ(margin(), 0) << "the noise is unknown";
  plan.noise_counts = 2;
  EXPECT_FLOAT_EQ(margin(), 5 * std::sqrt(3.0F) * 2);
  plan.calibration.noise.assign(64, 4.0F);
  EXPECT_FLOAT_EQ(margin(), 5 * std::sqrt(3.0F) * 4);
  plan.calibration.noise.clear();
  plan.sensel_type = SenselType::u8;
  EXPECT_FLOAT_EQ(margin(), 5 * std::sqrt(3.0F) * std::sqrt(4 + 1 / 12.0F));
}

TEST(KernelSource, ConstantsAreExact) {
  SolverPlan plan = bare_plan(8, 8, SenselType::u16);
  plan.skin.threshold_counts = 0.1;
  plan.skin.counts_per_newton = 317;
  const std::string source = kernel_source(plan, 1);
  EXPECT_EQ(std::strtof(macro(source, "PF_VALUE_threshold").c_str(), nullptr), 0.1F);
  EXPECT_EQ(std::strtof(macro(source, "PF_VALUE_normal_scale").c_str(), nullptr),
            static_cast<float>(1 / (2 * 317.0)));
  EXPECT_EQ(std::strtof(macro(source, "PF_VALUE_segment_point").c_str(), nullptr), 0.875F);
  plan.segment_point = 0.9;
  EXPECT_EQ(std::strtof(macro(kernel_source(plan, 1), "PF_VALUE_segment_point").c_str(), nullptr),
            0.9F);
  EXPECT_EQ(macro(source, "PF_VALUE_threshold").find("0x"), 0U);
}

TEST(KernelSource, WholeNumbersAreThoseOfBareBytes) {
  const auto is_whole = [](auto&& change, int lanes = 16) {
    SolverPlan plan = bare_plan(8, 64, SenselType::u8);
    change(plan);
    return macro(kernel_source(plan, lanes), "PF_WHOLE") != "(none)";
  };
  EXPECT_TRUE(is_whole([](SolverPlan&) {}));
  EXPECT_TRUE(is_whole([](SolverPlan& plan) {
    plan.skin.threshold_counts = 2.5;
    plan.skin.full_scale_counts = 250.3;
    plan.parity_tolerance_counts = 3.7;
    plan.noise_counts = 0.4;
  }));
  for (const double point : {0.5, 0.75, 0.875}) {
    EXPECT_TRUE(is_whole([&](SolverPlan& plan) { plan.segment_point = point; }));
  }
  EXPECT_FALSE(is_whole([](SolverPlan&) {}, 1));
  const auto is_not = [&](auto&& change) { EXPECT_FALSE(is_whole(change)); };
  is_not([](SolverPlan& plan) { plan.sensel_type = SenselType::u16; });
  is_not([](SolverPlan& plan) { plan.estimator = Estimator::paper; });
  is_not([](SolverPlan& plan) { plan.angles = true; });
  is_not([](SolverPlan& plan) {
    plan.uncertainty = true;
    plan.noise_counts = 1;
  });
  is_not([](SolverPlan& plan) { plan.baseline_rate = 0.1; });
  is_not([](SolverPlan& plan) { plan.skin.power_law = PowerLaw{0.9, 50}; });
  is_not([](SolverPlan& plan) { plan.skin.threshold_counts = 2.3; });
  is_not([](SolverPlan& plan) { plan.skin.threshold_counts = 1e9; });
  is_not([](SolverPlan& plan) { plan.skin.threshold_counts = 501; });
  is_not([](SolverPlan& plan) { plan.segment_point = 0.9; });
  is_not([](SolverPlan& plan) { plan.segment_point = 1; });
  is_not([](SolverPlan& plan) {
    plan.skin.threshold_counts = 20;
    plan.skin.full_scale_counts = 20;
  });
  is_not([](SolverPlan& plan) { plan.calibration.tare.assign(512, 0); });
  is_not([](SolverPlan& plan) { plan.calibration.gain.assign(512, 1); });
  is_not([](SolverPlan& plan) { plan.calibration.dead_zone.assign(512, 0); });
  is_not([](SolverPlan& plan) { plan.calibration.mask.assign(512, 1); });
}

TEST(KernelSource, ABlockIsNoWiderThanARow) {
  EXPECT_EQ(macro(kernel_source(bare_plan(8, 32, SenselType::u8), 16), "PF_LANES"), "16");
  EXPECT_EQ(macro(kernel_source(bare_plan(8, 31, SenselType::u8), 16), "PF_LANES"), "8");
  EXPECT_EQ(macro(kernel_source(bare_plan(8, 3, SenselType::u8), 16), "PF_LANES"), "1");
}

TEST(KernelSource, ProgramHoldsTheFilesOfTheTree) {
  const std::string_view program = kernel_program();
  std::size_t at = 0;
  for (const char* name : {"portable.h", "pillar/direct_solve.h", "frame/follow_baseline.cl"}) {
    std::ifstream file(std::string(PILLARFIELD_KERNELS) + "/" + name);
    std::stringstream text;
    text << "#line 1 \"" << name << "\"\n" << file.rdbuf();
    at = program.find(text.str(), at);
    EXPECT_NE(at, std::string_view::npos) << name;
  }
}

}  // namespace
}  // namespace pillarfield
