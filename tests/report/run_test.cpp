// What is read of the JSON of pillarfield-bench and of pillarfield live, and what is complained of.

#include "report/speed/run.h"

#include <gtest/gtest.h>

#include <string>

#include "made_up_run.h"
#include "pillarfield/error.h"

namespace pillarfield::report {
namespace {

/// The text of the Error that `act` throws.
template <class Act>
std::string complaint_of(Act act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(BenchRun, HasRowsWithTheirCounters) {
  const BenchRun run = made_up_run({{"size/1024", R"("ns_per_pillar":1.5,"label":"64 frames")"},
                                    {"size/10000", R"("ns_per_pillar":0.5)"},
                                    {"stage/none", R"("ns_per_pillar":0.25)"}});
  EXPECT_EQ(run.value("size/1024", "ns_per_pillar"), 1.5);
  EXPECT_EQ(run.find("stage/none", "ns_per_pillar"), 0.25);
  EXPECT_EQ(run.label("size/1024"), "64 frames");
  EXPECT_EQ(run.rows_of("size").size(), 2U);
  EXPECT_EQ(run.context("num_cpus"), "2");
  EXPECT_EQ(run.context("weather"), "");
}

TEST(BenchRun, ComplainsOfARowThatIsNotThere) {
  const BenchRun run = made_up_run({{"size/1024", R"("ns_per_pillar":1.5)"}});
  const std::string complaint =
      complaint_of([&] { static_cast<void>(run.value("size/10000", "ns_per_pillar")); });
  EXPECT_NE(complaint.find("made_up.json"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("there is no row 'size/10000'"), std::string::npos) << complaint;
  EXPECT_NE(complaint.find("./dev report speed"), std::string::npos) << complaint;
  EXPECT_EQ(run.find("size/10000", "ns_per_pillar"), std::nullopt);
}

TEST(BenchRun, ComplainsOfACounterThatIsNotThere) {
  const BenchRun run = made_up_run({{"size/1024", R"("ns_per_pillar":1.5)"}});
  for (const auto& complaint :
       {complaint_of([&] { static_cast<void>(run.value("size/1024", "of_ceiling")); }),
        complaint_of([&] { static_cast<void>(run.find("size/1024", "of_ceiling")); })}) {
    EXPECT_NE(complaint.find("'size/1024' has no 'of_ceiling'"), std::string::npos) << complaint;
  }
}

TEST(BenchRun, KnowsWhyARowWasLeftOut) {
  const BenchRun run = made_up_run(
      {{"opponent/numpy", R"("error_occurred":true,"error_message":"skipped: no NumPy")"},
       {"size/1024", R"("ns_per_pillar":1.5)"}});
  EXPECT_EQ(run.why_left_out("opponent/numpy"), "skipped: no NumPy");
  EXPECT_EQ(run.why_left_out("size/1024"), "");
  EXPECT_EQ(run.find("opponent/numpy", "speedup"), std::nullopt);
  EXPECT_NE(complaint_of([&] {
              static_cast<void>(run.value("opponent/numpy", "speedup"));
            }).find("no NumPy"),
            std::string::npos);
}

TEST(BenchRun, ComplainsOfWhatIsNoRun) {
  for (const char* const text : {"", "{", "[]", "{}", R"({"context":{},"benchmarks":[{}]})"}) {
    const std::string complaint =
        complaint_of([&] { static_cast<void>(BenchRun("torn.json", text)); });
    EXPECT_NE(complaint.find("torn.json"), std::string::npos) << text << ": " << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos) << complaint;
  }
}

TEST(LiveRun, ReadsWhatNeverCame) {
  const LiveRun live = parse_live_run("live.json", R"({"source":"a.toml","pillar_rows":3,
      "pillar_cols":4,"rate_hz":1000,"seconds":1.5,"deadline_ms":1,"scheduled":10,"dropped":2,
      "missed":1,"latency_p50_ms":0.5,"latency_p99_ms":null,"latency_p99_9_ms":null,
      "latency_longest_ms":1.2,"contact_share":0.1,"cpu_cores":0.7,
      "latency_histogram":[{"from_ms":0.4,"to_ms":0.5,"frames":8}]})");
  EXPECT_EQ(live.pillars, 12U);
  EXPECT_EQ(live.p50_ms, 0.5);
  EXPECT_EQ(live.p99_ms, std::nullopt);
  EXPECT_EQ(live.longest_ms, 1.2);
  ASSERT_EQ(live.histogram.size(), 1U);
  EXPECT_EQ(live.histogram[0].frames, 8U);
  EXPECT_NE(complaint_of([] {
              static_cast<void>(parse_live_run("live.json", R"({"source":"a.toml"})"));
            }).find("live.json"),
            std::string::npos);
}

}  // namespace
}  // namespace pillarfield::report
