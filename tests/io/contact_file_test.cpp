#include "pillarfield/contact_file.h"

#include <limits>

#include "pillarfield/force_file.h"
#include "tests/io/damage.h"
#include "tests/io/sample_contacts.h"

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

ContactOptions sample_options() {
  return {.minimum_pillars = 3, .friction = {.given = 0.5}, .reach_mm = 7};
}

ContactFileInfo sample_info() { return {1.25, "a \"quoted\"\\\n name.h5", sample_options()}; }

ForceFileInfo force_info(const std::optional<ContactOptions>& contacts = sample_options()) {
  ForceFileInfo info = {2, 3, 1.25, "direct", "a device", "press.h5"};
  info.contacts = contacts;
  return info;
}

void append(ForceSink& sink, std::uint64_t index) {
  const ForceField forces = sample_forces(index, 2, 3);
  const FrameContacts found = sample_contacts(index);
  sink.append(
      {.forces = forces.view(), .contacts = &found, .time_s = 0.25 * static_cast<double>(index)});
}

void write_forces(const std::filesystem::path& path, std::uint64_t frames) {
  const auto sink = create_force_sink(path, force_info());
  for (std::uint64_t index = 0; index < frames; ++index) append(*sink, index);
  sink->finish();
}

/// Damaged files hold any value.
TEST(ContactColumns, TakeAnyNumber) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double value :
       {-1.0, 1e300, kInfinity, -kInfinity, 4.0, 0.5, std::numeric_limits<double>::quiet_NaN()}) {
    ContactQuantities quantities;
    TrackedContact contact;
    EndedContact ended;
    for (const auto& column : quantity_columns(true)) column.set(quantities, value);
    for (const auto& column : identity_columns()) column.set(contact, value);
    for (const auto& column : ended_columns()) column.set(ended, value);
    EXPECT_FALSE(cells_of(quantity_columns(true), quantities).empty());
    EXPECT_FALSE(cells_of(identity_columns(), contact).empty());
  }
}

/// Files of a skin with a surface hold forces and moments in the body's frame; others do not.
TEST(ContactFiles, HoldTheWrenchWhereTheSkinHasASurface) {
  const TemporaryDirectory directory;
  Surface surface;
  surface.shape = SurfaceShape::cylinder;
  surface.radius_mm = 60;
  surface.axis_deg = 30;
  for (const bool curved : {false, true}) {
    ForceFileInfo info = force_info();
    if (curved) info.contacts->surface = info.surface = surface;
    const auto path = directory / (curved ? "curved.h5" : "flat.h5");
    const auto sink = create_force_sink(path, info);
    for (std::uint64_t index = 0; index < 6; ++index) append(*sink, index);
    sink->finish();
    const ForceFileReader reader(path);
    ASSERT_EQ(reader.info().surface.has_value(), curved);
    ASSERT_EQ(reader.info().contacts->surface.has_value(), curved);
    const ContactQuantities read = reader.read_contacts(3).contacts.at(0).quantities;
    const ContactQuantities written = sample_contacts(3).contacts.at(0).quantities;
    ASSERT_EQ(read.wrench.has_value(), curved);
    if (!curved) continue;
    EXPECT_EQ(reader.info().surface->axis_deg, 30);
    EXPECT_EQ(cells_of(quantity_columns(true), read), cells_of(quantity_columns(true), written));
  }
}

TEST(ContactSink, RefusesWhatItCannotWrite) {
  const TemporaryDirectory directory;
  for (const std::string name : {"c.h5", "c.txt", "c", ".csv"}) {
    EXPECT_TRUE(has_all(error_of([&] { (void)create_contact_sink(directory / name, {}); }),
                        {name, ".csv or .json"}));
  }
  EXPECT_TRUE(has_all(error_of([&] { (void)create_contact_sink(directory / "no/c.csv", {}); }),
                      {"no/c.csv"}));
  EXPECT_TRUE(directory.names().empty());
  for (const std::string name : {"c.csv", "c.json"}) {
    const auto sink = create_contact_sink(directory / name, sample_info());
    const FrameContacts found;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(has_all(error_of([&] { sink->append({.contacts = &found, .time_s = nan}); }),
                        {name, "its time is nan"}));
    EXPECT_TRUE(has_all(error_of([&] { sink->append({}); }), {name, "without its contacts"}));
  }
}

TEST(ContactsOfForceFile, AreKept) {
  for (const std::uint64_t frames : {0u, 1u, 15u, 16u, 50u, 2100u}) {
    const TemporaryDirectory directory;
    write_forces(directory / "f.h5", frames);
    const ForceFileReader reader(directory / "f.h5");
    ASSERT_EQ(reader.frames(), frames);
    ASSERT_TRUE(reader.info().contacts.has_value());
    EXPECT_EQ(reader.info().contacts->minimum_pillars, 3);
    EXPECT_EQ(reader.info().contacts->friction.given, 0.5);
    EXPECT_EQ(reader.info().contacts->reach_mm, 7);
    for (std::uint64_t index = 0; index<frames; index += frames> 100 ? 97 : 1) {
      ASSERT_EQ(written_out(reader.read_contacts(index)), written_out(sample_contacts(index)))
          << index;
    }
    EXPECT_TRUE(has_all(error_of([&] { (void)reader.read_contacts(frames); }), {"has no frame"}));
  }
}

TEST(ContactsOfForceFile, AreWrittenOnlyOnRequest) {
  const TemporaryDirectory directory;
  const auto sink = create_force_sink(directory / "f.h5", force_info(std::nullopt));
  append(*sink, 0);
  sink->finish();
  const ForceFileReader reader(directory / "f.h5");
  EXPECT_FALSE(reader.info().contacts);
  EXPECT_TRUE(has_all(error_of([&] { (void)reader.read_contacts(0); }),
                      {"f.h5", "holds no contacts", "--contacts"}));
  for (const std::string name : {"f.csv", "f.npy"}) {
    EXPECT_TRUE(has_all(error_of([&] { (void)create_force_sink(directory / name, force_info()); }),
                        {name, "only HDF5"}));
  }
}

TEST(ContactsOfForceFile, ComeWithEachFrame) {
  const TemporaryDirectory directory;
  const auto sink = create_force_sink(directory / "f.h5", force_info());
  append(*sink, 0);
  const ForceField forces = sample_forces(1, 2, 3);
  EXPECT_TRUE(has_all(error_of([&] { sink->append({.forces = forces.view()}); }),
                      {"f.h5", "without its contacts"}));
  append(*sink, 1);
  sink->finish();
  const ForceFileReader reader(directory / "f.h5");
  ASSERT_EQ(reader.frames(), 2);
  EXPECT_EQ(written_out(reader.read_contacts(1)), written_out(sample_contacts(1)));
}

/// Changes the one value of an unsigned column at `row`.
void overwrite(const std::filesystem::path& path, const char* column, hsize_t row,
               std::uint64_t value) {
  edit(path, [&](hid_t file) {
    const hid_t dataset = H5Dopen2(file, column, H5P_DEFAULT);
    const hid_t space = H5Dget_space(dataset);
    const hsize_t one = 1;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &row, nullptr, &one, nullptr);
    const hid_t memory = H5Screate_simple(1, &one, nullptr);
    EXPECT_GE(H5Dwrite(dataset, H5T_NATIVE_UINT64, memory, space, H5P_DEFAULT, &value), 0);
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(dataset);
  });
}

TEST(ContactsOfForceFile, DamageIsAnError) {
  const TemporaryDirectory directory;
  const auto path = directory / "f.h5";
  for (const char* column : {"/contacts/patch/first_contact", "/contacts/patch/contacts",
                             "/contacts/patch/first_ended", "/contacts/patch/ended"}) {
    for (const std::uint64_t value : {std::uint64_t{30}, UINT64_MAX, std::uint64_t{INT64_MAX}}) {
      write_forces(path, 8);
      overwrite(path, column, 5, value);
      const ForceFileReader reader(path);
      EXPECT_TRUE(has_all(error_of([&] { (void)reader.read_contacts(5); }), {"f.h5", "damaged"}));
      EXPECT_EQ(written_out(reader.read_contacts(7)), written_out(sample_contacts(7)));
    }
  }
  for (const char* name : {"/contacts/id", "/contacts/slip_margin", "/contacts/patch",
                           "/contacts/patch/normal_n", "/contacts/ended/id"}) {
    write_forces(path, 2);
    edit(path, [&](hid_t file) { remove_link(file, name); });
    EXPECT_TRUE(has_all(error_of([&] { const ForceFileReader reader(path); }), {"has no", name}));
  }
}

/// Files of earlier versions lack the friction's standard deviation.
TEST(ContactTables, WithoutTheFrictionsDeviationAreRead) {
  const TemporaryDirectory directory;
  const auto path = directory / "f.h5";
  write_forces(path, 2);
  edit(path, [](hid_t file) {
    remove_link(file, "/contacts/friction_deviation");
    remove_link(file, "/contacts/patch/friction_deviation");
  });
  FrameContacts expected = sample_contacts(1);
  expected.total.friction_deviation.reset();
  for (TrackedContact& contact : expected.contacts) contact.quantities.friction_deviation.reset();
  EXPECT_EQ(written_out(ForceFileReader(path).read_contacts(1)), written_out(expected));
}

}  // namespace
}  // namespace pillarfield
