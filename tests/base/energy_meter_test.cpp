#include "base/energy_meter.h"

#include <gtest/gtest.h>

#include <fstream>

namespace pillarfield {
namespace {

/// A tree like /sys/class/powercap.
class Powercap {
 public:
  Powercap() { std::filesystem::create_directories(root_); }
  ~Powercap() { std::filesystem::remove_all(root_); }
  Powercap(const Powercap&) = delete;
  Powercap& operator=(const Powercap&) = delete;

  [[nodiscard]] const std::filesystem::path& root() const { return root_; }

  void set(const std::string& zone, const std::string& file, const std::string& text) const {
    std::filesystem::create_directories(root_ / zone);
    std::ofstream(root_ / zone / file) << text << '\n';
  }

  void add(const std::string& zone, const std::string& name, const std::string& energy_uj) const {
    set(zone, "name", name);
    set(zone, "max_energy_range_uj", "10000000");
    set(zone, "energy_uj", energy_uj);
  }

 private:
  std::filesystem::path root_ = std::filesystem::path(::testing::TempDir()) /
                                ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST(EnergyMeter, AddsThePackagesOnceEach) {
  const Powercap powercap;
  powercap.add("intel-rapl:0", "package-0", "1000000");
  powercap.add("intel-rapl:0:0", "core", "500000");
  powercap.add("intel-rapl:1", "package-1", "9000000");
  powercap.add("intel-rapl:2", "psys", "0");
  powercap.add("intel-rapl-mmio:0", "package-0", "1000000");
  EnergyMeter meter(powercap.root());
  EXPECT_EQ(meter.joules(), 0);
  for (const char* zone : {"intel-rapl:0", "intel-rapl-mmio:0", "intel-rapl:2"}) {
    powercap.set(zone, "energy_uj", "3000000");
  }
  powercap.set("intel-rapl:0:0", "energy_uj", "2000000");
  powercap.set("intel-rapl:1", "energy_uj", "1500000");  // wrapped at 10 J
  EXPECT_DOUBLE_EQ(meter.joules().value(), 2 + 2.5);
  powercap.set("intel-rapl:0", "energy_uj", "3500000");
  EXPECT_DOUBLE_EQ(meter.joules().value(), 5);
}

TEST(EnergyMeter, SaysWhereNothingCanBeRead) {
  const Powercap powercap;
  EXPECT_EQ(EnergyMeter(powercap.root() / "absent").joules(), std::nullopt);
  EXPECT_EQ(EnergyMeter(powercap.root()).joules(), std::nullopt);
  powercap.add("intel-rapl:0", "package-0", "1000000");
  EnergyMeter meter(powercap.root());
  EXPECT_TRUE(meter.joules().has_value());
  std::filesystem::remove(powercap.root() / "intel-rapl:0" / "energy_uj");
  EXPECT_EQ(meter.joules(), std::nullopt);
}

}  // namespace
}  // namespace pillarfield
