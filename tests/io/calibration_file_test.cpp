#include "pillarfield/calibration_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "pillarfield/recording.h"
#include "skin/effect_parameters.h"
#include "tests/io/damage.h"
#include "tests/io/full_files.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

using Names = std::vector<std::string>;

/// The parameters by name, as text.
std::string text_of(const SensorEffects& effects) {
  std::string text;
  for (const EffectParameter& parameter : parameters_of(effects)) {
    text += fmt::format("{} {}\n", parameter.name, fmt::join(parameter.values, " "));
  }
  return text;
}

void expect_equal(const SkinCalibration& read, const SkinCalibration& written) {
  EXPECT_EQ(read.rows, written.rows);
  EXPECT_EQ(read.cols, written.cols);
  EXPECT_EQ(planes_of(read.planes), planes_of(written.planes));
  EXPECT_EQ(text_of(read.planes.effects), text_of(written.planes.effects));
  EXPECT_EQ(read.sensel_pitch_mm, written.sensel_pitch_mm);
  EXPECT_EQ(read.threshold_counts, written.threshold_counts);
  EXPECT_EQ(read.threshold_factor, written.threshold_factor);
  EXPECT_EQ(read.counts_per_newton, written.counts_per_newton);
  ASSERT_EQ(read.power_law.has_value(), written.power_law.has_value());
  if (read.power_law) {
    EXPECT_EQ(read.power_law->exponent, written.power_law->exponent);
    EXPECT_EQ(read.power_law->reference_counts, written.power_law->reference_counts);
  }
  ASSERT_EQ(read.history.size(), written.history.size());
  for (std::size_t i = 0; i < read.history.size(); ++i) {
    EXPECT_EQ(read.history[i].step, written.history[i].step);
    EXPECT_EQ(read.history[i].sources, written.history[i].sources);
    EXPECT_EQ(read.history[i].frames, written.history[i].frames);
    EXPECT_EQ(read.history[i].parameters, written.history[i].parameters);
    EXPECT_EQ(read.history[i].date_utc, written.history[i].date_utc);
    EXPECT_EQ(read.history[i].program_version, written.history[i].program_version);
  }
}

TEST(CalibrationFile, GivesBackWhatWasWritten) {
  const TemporaryDirectory directory;
  const auto path = directory / "cal.h5";
  SkinCalibration calibration = full_calibration();
  calibration.planes.gain[0] = 0.01F;  // below 0.01
  calibration.planes.gain[1] = 100;
  write_calibration_file(path, calibration);
  expect_equal(read_calibration_file(path), calibration);
  EXPECT_TRUE(is_calibration_file(path));
  EXPECT_EQ(directory.names(), Names{"cal.h5"});
}

TEST(CalibrationFile, HoldsACurveInsteadOfAPowerLaw) {
  const TemporaryDirectory directory;
  SkinCalibration calibration = full_calibration();
  calibration.planes.effects.curve = {{10, 20, 70}, {12, 25, 90}};
  EXPECT_TRUE(has_all(error_of([&] { write_calibration_file(directory / "cal.h5", calibration); }),
                      {"power law and a response curve"}));
  calibration.power_law.reset();
  write_calibration_file(directory / "cal.h5", calibration);
  const SkinCalibration read = read_calibration_file(directory / "cal.h5");
  expect_equal(read, calibration);
  EXPECT_EQ(read.planes.effects.curve.loads, (std::vector<double>{12, 25, 90}));

  Skin skin;
  skin.rows = read.rows;
  skin.cols = read.cols;
  skin.power_law = {1.5, 100};
  RecordingWriter writer(directory / "r.h5", skin, SenselType::u8, {}, {});
  writer.finish();
  Calibration planes = open_frames(directory / "r.h5")->calibration();
  EXPECT_TRUE(planes.effects.empty());
  planes.effects.arm_mm = 3;
  apply(read, skin, planes);
  EXPECT_EQ(text_of(planes.effects), text_of(calibration.planes.effects));
  EXPECT_FALSE(skin.power_law);
}

TEST(CalibrationFile, MayHoldLittle) {
  const TemporaryDirectory directory;
  const auto path = directory / "cal.h5";
  SkinCalibration bare;
  bare.rows = 2;
  bare.cols = 3;
  write_calibration_file(path, bare);
  expect_equal(read_calibration_file(path), bare);
}

TEST(CalibrationFile, RefusesOtherFormats) {
  const TemporaryDirectory directory;
  const auto path = directory / "cal.h5";
  write_calibration_file(path, full_calibration());
  EXPECT_TRUE(has_all(error_of([&] { (void)open_frames(path); }),
                      {"cal.h5", "pillarfield-calibration", "a calibration"}));
  Skin skin;
  skin.rows = skin.cols = 4;
  RecordingWriter writer(directory / "r.h5", skin, SenselType::u8, {}, {});
  writer.finish();
  EXPECT_FALSE(is_calibration_file(directory / "r.h5"));
  EXPECT_FALSE(is_calibration_file(directory / "absent.h5"));
  EXPECT_TRUE(has_all(error_of([&] { (void)read_calibration_file(directory / "r.h5"); }),
                      {"r.h5", "pillarfield-recording", "calibrate"}));
  write_bytes(directory / "text", "tare = 3\n");
  EXPECT_TRUE(has_all(error_of([&] { (void)read_calibration_file(directory / "text"); }),
                      {"text", "is not an HDF5 file"}));
}

const double kNan = std::numeric_limits<double>::quiet_NaN();

const Damage kDamages[] = {
    {"version 2", [](hid_t f) { set_number(f, "/", "version", 2); }, {"version is 2"}},
    {"no skin", [](hid_t f) { remove_link(f, "/skin"); }, {"has no /skin"}},
    {"no rows",
     [](hid_t f) { remove_attribute(f, "/skin", "rows"); },
     {"/skin", "no attribute 'rows'"}},
    {"half a column", [](hid_t f) { set_number(f, "/skin", "cols", 7.5); }, {"cols is 7.5"}},
    {"NaN rows", [](hid_t f) { set_number(f, "/skin", "rows", kNan); }, {"rows is nan"}},
    {"other size", [](hid_t f) { set_number(f, "/skin", "rows", 8); }, {"6 x 8", "8 x 8"}},
    {"leak of one half",
     [](hid_t f) { set_number(f, "/calibration/effects", "leak_inside", 0.5); },
     {"leak_inside is 0.5"}},
    {"leak half there",
     [](hid_t f) { remove_attribute(f, "/calibration/effects", "leak_across"); },
     {"/calibration/effects", "no 'leak_across'"}},
    {"half a tile",
     [](hid_t f) { set_number(f, "/calibration/effects", "wire_tile_rows", 0.5); },
     {"'wire_tile_rows' is 0.5"}},
    {"arm NaN",
     [](hid_t f) { set_number(f, "/calibration/effects", "arm_mm", kNan); },
     {"arm_mm is nan"}},
    {"one weight of two plays",
     [](hid_t f) { set_number(f, "/calibration/effects", "play_weights", 0.5); },
     {"'play_weights' has 1 values"}},
    {"a curve without loads",
     [](hid_t f) { set_number(f, "/calibration/effects", "curve_readings", 3); },
     {"1 readings and 0 loads"}},
    {"one bend plane",
     [](hid_t f) { remove_link(f, "/calibration/bend_y"); },
     {"bend_x, bend_y and bend_xy"}},
};

TEST(CalibrationFile, DamageEndsInOneError) {
  const TemporaryDirectory directory;
  expect_refused(
      directory / "cal.h5", kDamages,
      [](const auto& path) { write_calibration_file(path, full_calibration()); },
      [](const auto& path) { (void)read_calibration_file(path); });
}

}  // namespace
}  // namespace pillarfield
