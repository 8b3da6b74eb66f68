// Damage of every object of our files and of every value that their tables list, which
// docs/formats.md names.

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <regex>

#include "base/number_text.h"
#include "skin/skin_fields.h"
#include "tests/io/damage.h"
#include "tests/io/full_files.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

struct FullFile {
  const char* name;
  void (*write)(const std::filesystem::path& path);
  void (*read)(const std::filesystem::path& path);
};

void write_full_calibration(const std::filesystem::path& path) {
  write_calibration_file(path, full_calibration(), Replace::anything);
}

/// The checksums of our own files keep HDF5 from crashing in the test process.
const ReadOptions kTrusted = {.trust = true};

void read_all_frames(const std::filesystem::path& path) {
  const auto source = open_frames(path, kTrusted);
  FrameBuffer frame(source->sensel_type(), source->skin().rows, source->skin().cols);
  ForceField truth;
  for (std::uint64_t index = 0; index < source->frames(); ++index) {
    source->read(index, frame);
    if (source->has_truth()) source->read_truth(index, truth);
  }
}

void read_all_forces(const std::filesystem::path& path) {
  const ForceFileReader reader(path, kTrusted);
  ForceField forces;
  for (std::uint64_t index = 0; index < reader.frames(); ++index) {
    reader.read(index, forces);
    if (reader.info().contacts) (void)reader.read_contacts(index);
  }
}

const FullFile kFullFiles[] = {
    {"recording", write_full_recording, read_all_frames},
    {"calibration", write_full_calibration,
     [](const auto& path) { check(read_calibration_file(path, kTrusted), "read"); }},
    {"forces", write_full_forces, read_all_forces}};

/// An object of a file, or one of its attributes.
struct Place {
  std::string object;
  std::string attribute;  ///< empty: the object itself
  bool is_group = false;

  [[nodiscard]] std::string name() const {
    return attribute.empty() ? object.substr(object.rfind('/') + 1) : attribute;
  }
};

herr_t note_attribute(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

herr_t note_object(hid_t file, const char* name, const H5O_info_t* info, void* places) {
  auto& all = *static_cast<std::vector<Place>*>(places);
  const bool is_root = std::string_view(name) == ".";
  const std::string object = is_root ? "/" : "/" + std::string(name);
  if (!is_root) all.push_back({object, "", info->type == H5O_TYPE_GROUP});
  std::vector<std::string> attributes;
  const hid_t opened = H5Oopen(file, name, H5P_DEFAULT);
  H5Aiterate2(opened, H5_INDEX_NAME, H5_ITER_INC, nullptr, note_attribute, &attributes);
  H5Oclose(opened);
  for (const std::string& attribute : attributes) all.push_back({object, attribute});
  return 0;
}

std::vector<Place> places_of(const std::filesystem::path& path) {
  std::vector<Place> places;
  edit(path, [&](hid_t file) { H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, note_object, &places); });
  return places;
}

/// True for what is written for people and other programs, and not read.
bool is_for_others(const FullFile& file, const Place& place) {
  static const std::regex names("unit|words|sign_convention|flushed_.*|frame|program_version");
  const bool is_read = file.read != read_all_forces && place.name() == "program_version";
  const bool is_end = place.object.starts_with("/uncertainty/");
  return (std::regex_match(place.name(), names) && !is_read) || is_end;
}

bool is_text(hid_t file, const Place& place) {
  const hid_t attribute = H5Aopen_by_name(file, place.object.c_str(), place.attribute.c_str(),
                                          H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  const bool is = H5Tget_class(type) == H5T_STRING;
  H5Tclose(type);
  H5Aclose(attribute);
  return is;
}

/// Replaces a dataset by an empty one of this type, with `more` dimensions.
void replace_type(hid_t file, const std::string& name, hid_t type, int more) {
  const hid_t old = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  const hid_t old_space = H5Dget_space(old);
  std::vector<hsize_t> extent(static_cast<std::size_t>(H5Sget_simple_extent_ndims(old_space)));
  H5Sget_simple_extent_dims(old_space, extent.data(), nullptr);
  H5Sclose(old_space);
  H5Dclose(old);
  extent.resize(extent.size() + static_cast<std::size_t>(more), 1);
  remove_link(file, name.c_str());
  const hid_t space = H5Screate_simple(static_cast<int>(extent.size()), extent.data(), nullptr);
  H5Dclose(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Sclose(space);
}

/// A number in place of a text, a text in place of a number; of a dataset, texts.
void change_type(hid_t file, const Place& place) {
  const char* const object = place.object.c_str();
  if (place.attribute.empty()) return replace_type(file, place.object, H5T_C_S1, 0);
  is_text(file, place) ? set_number(file, object, place.attribute.c_str(), 1)
                       : set_text(file, object, place.attribute.c_str(), "wide");
}

class FullFiles : public testing::Test {
 protected:
  /// The error of reading a new file after a change; empty if it is read.
  std::string error_after(const FullFile& file, const std::function<void(hid_t)>& change) {
    file.write(path_);
    edit(path_, change);
    try {
      file.read(path_);
    } catch (const Error& error) {
      EXPECT_TRUE(has_all(error.what(), {path_.string()}));
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
      return error.what();
    }
    return {};
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "f.h5";
};

TEST_F(FullFiles, EveryObjectOfAnotherTypeOrRankIsRefusedByItsName) {
  for (const FullFile& file : kFullFiles) {
    file.write(path_);
    for (const Place& place : places_of(path_)) {
      SCOPED_TRACE(fmt::format("{}: {} {}", file.name, place.object, place.attribute));
      if (place.is_group || is_for_others(file, place)) continue;
      const auto refused = [&](const auto& change) {
        EXPECT_TRUE(has_all(error_after(file, change), {place.name()}));
      };
      refused([&](hid_t opened) { change_type(opened, place); });
      if (!place.attribute.empty()) continue;
      refused([&](hid_t opened) { replace_type(opened, place.object, H5T_IEEE_F32LE, 1); });
    }
  }
}

TEST_F(FullFiles, WithoutAnObjectAreReadOrNameIt) {
  for (const FullFile& file : kFullFiles) {
    file.write(path_);
    for (const Place& place : places_of(path_)) {
      SCOPED_TRACE(fmt::format("{}: {} {}", file.name, place.object, place.attribute));
      const std::string error = error_after(file, [&](hid_t opened) {
        place.attribute.empty()
            ? remove_link(opened, place.object.c_str())
            : remove_attribute(opened, place.object.c_str(), place.attribute.c_str());
      });
      EXPECT_TRUE(error.empty() || has_all(error, {place.name()}));
    }
  }
}

TEST_F(FullFiles, CutOrChangedEndInAnErrorOrAreRead) {
  for (const FullFile& file : kFullFiles) {
    SCOPED_TRACE(file.name);
    file.write(path_);
    const std::string whole = bytes_of(path_);
    read_changed(directory_ / "changed.h5", whole, 100, file.read);
    read_cut(directory_ / "cut.h5", whole, 70, [&](const auto& path) {
      file.read(path);
      ADD_FAILURE() << "a part was read";
    });
  }
}

TEST_F(FullFiles, HoldConstantsWithinTheirRanges) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](const FullFile& file, const NumberField& field) {
    SCOPED_TRACE(fmt::format("{}: {}", file.name, field.name));
    for (const double value : {field.low - 1, 2 * field.high, nan}) {
      const std::string error =
          error_after(file, [&](hid_t opened) { set_number(opened, "/skin", field.name, value); });
      EXPECT_TRUE(has_all(error, {fmt::format("{} is {}", field.name, value),
                                  fmt::format("[{}, {}]", field.low, field.high)}));
    }
  };
  Skin skin;
  visit_constants(skin, [&](const NumberField& field, auto&) { refused(kFullFiles[0], field); });
  SkinCalibration calibration;
  visit_constants(calibration,
                  [&](const NumberField& field, auto&) { refused(kFullFiles[1], field); });
  for (const PowerLawField& field : kPowerLawFields) refused(kFullFiles[1], field.number);
  refused(kFullFiles[1], kThresholdFactor);
}

/// Changes the value in row 1, column 1; the dataset becomes one of floats.
void set_value(hid_t file, const std::string& name, std::size_t cols, double value) {
  std::vector<double> values(kFullSize * cols, 1.0);
  values[cols + 1] = value;
  replace_type(file, name, H5T_IEEE_F64LE, 0);
  const hid_t dataset = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
}

TEST_F(FullFiles, HoldPlanesWithinTheirRanges) {
  Calibration planes;
  const auto refused = [&](const FullFile& file, std::size_t cols, double largest) {
    visit_planes(planes, [&](const PlaneField& field, auto&) {
      const std::string name = fmt::format("/calibration/{}", field.name);
      SCOPED_TRACE(file.name + name);
      if (file.read == kFullFiles[0].read && name.find("bend") != std::string::npos) return;
      const double infinity = std::numeric_limits<double>::infinity();
      for (const double value :
           {std::floor(field.low_for(largest) * 1.01) - 1, field.high_for(largest) * 1.01 + 1,
            std::nan(""), infinity, -infinity}) {
        const std::string error =
            error_after(file, [&](hid_t opened) { set_value(opened, name, cols, value); });
        EXPECT_TRUE(has_all(error, {fmt::format("'{}' is", field.name), "row 1, column 1"}))
            << value;
      }
    });
  };
  refused(kFullFiles[0], kFullSize, largest_plane_counts(SenselType::u8));
  refused(kFullFiles[1], 8, kMaxPlaneCounts);
}

/// "0.01 to 1,000,000".
std::string range_in_words(double low, double high) {
  return fmt::format(
      "{} to {}", low,
      high < 1000 ? fmt::format("{}", high) : grouped(static_cast<std::uint64_t>(high)));
}

TEST_F(FullFiles, AndTheirRangesAreInTheDocumentation) {
  std::ifstream file(PILLARFIELD_FORMATS);
  std::vector<std::string> rows;
  std::string all;
  for (std::string line; std::getline(file, line);) {
    all += line + "\n";
    if (line.starts_with("|")) rows.push_back(line);
  }
  const auto stated = [&](const char* name, double low, double high) {
    const bool found = std::ranges::any_of(rows, [&](const std::string& row) {
      return bool{has_all(row, {name, range_in_words(low, high)})};
    });
    EXPECT_TRUE(found) << name << ", " << range_in_words(low, high);
  };
  SkinCalibration calibration;
  stated("`counts_per_newton`", kMinCountsPerNewton, kMaxCountsPerNewton);
  for (const auto& [field, member] : kPowerLawFields) stated(field.name, field.low, field.high);
  stated(kThresholdFactor.name, kThresholdFactor.low, kThresholdFactor.high);
  visit_planes(calibration.planes, [&](const PlaneField& field, auto&) {
    if (!field.is_reading && field.high < kMaxPlaneCounts && field.low > 0) {
      stated(field.name, field.low, field.high);
    }
  });
  for (const FullFile& full : kFullFiles) {
    full.write(path_);
    for (const Place& place : places_of(path_)) {
      // Quantities of contacts are in docs/contacts_found.md.
      if (place.object.starts_with("/contacts") && place.attribute.empty()) continue;
      if (place.object.starts_with("/history/")) continue;
      EXPECT_NE(all.find(place.name()), std::string::npos) << place.object << place.attribute;
    }
  }
}

}  // namespace
}  // namespace pillarfield
