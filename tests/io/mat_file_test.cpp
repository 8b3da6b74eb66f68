#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "pillarfield/array_axes.h"
#include "pillarfield/recording.h"
#include "tests/io/damage.h"

// A writer of little-endian MAT-files of version 5, which shares no code with the reader. It
// follows "MAT-File Format" of The MathWorks.
namespace pillarfield::io_test::mat {

/// The classes of MATLAB's values, mxCELL_CLASS to mxUINT64_CLASS.
enum class MxClass : std::uint32_t {
  cell = 1,
  structure = 2,
  text = 4,
  sparse = 5,
  real64 = 6,
  real32 = 7,
  uint8 = 9,
  int16 = 10,
  uint16 = 11
};

/// The type of stored numbers, miINT8 to miUINT64.
template <class Number>
constexpr std::uint32_t mi_type() {
  if constexpr (std::is_same_v<Number, float>) return 7;
  if constexpr (std::is_same_v<Number, double>) return 9;
  constexpr bool kSigned = std::is_signed_v<Number>;
  switch (sizeof(Number)) {
    case 1:
      return kSigned ? 1 : 2;
    case 2:
      return kSigned ? 3 : 4;
    case 4:
      return kSigned ? 5 : 6;
    default:
      return kSigned ? 12 : 13;
  }
}

constexpr std::uint32_t kMxComplex = 0x800;

template <class Number>
[[nodiscard]] inline std::string number(Number value) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return bytes;
}

[[nodiscard]] inline std::string header() {
  std::string text = "MATLAB 5.0 MAT-file, written by a test";
  text.resize(124, ' ');
  return text + number(std::uint16_t{0x0100}) + number(std::uint16_t{0x4d49});
}

/// An element of that type; up to four bytes lie within its tag, as MATLAB writes them.
[[nodiscard]] inline std::string element(std::uint32_t type, std::string data) {
  const auto size = static_cast<std::uint32_t>(data.size());
  const bool is_small = size > 0 && size <= 4;
  const std::string tag = is_small ? number(size << 16U | type) : number(type) + number(size);
  data.resize(is_small ? 4 : (data.size() + 7) / 8 * 8);
  return tag + data;
}

template <class Number>
[[nodiscard]] inline std::string numbers(const std::vector<Number>& values) {
  std::string data;
  for (const Number value : values) data += number(value);
  return element(mi_type<Number>(), data);
}

[[nodiscard]] inline std::string matrix(MxClass kind, const std::vector<std::int32_t>& shape,
                                        const std::string& name, const std::string& content,
                                        std::uint32_t flags = 0) {
  const std::vector<std::uint32_t> words = {static_cast<std::uint32_t>(kind) | flags, 0};
  return element(14, numbers(words) + numbers(shape) + element(1, name) + content);
}

/// An array of MATLAB's class with numbers of another type, column by column.
template <class Number>
[[nodiscard]] inline std::string array(MxClass kind, const std::vector<std::int32_t>& shape,
                                       const std::string& name, const std::vector<Number>& values,
                                       std::uint32_t flags = 0) {
  return matrix(kind, shape, name, numbers(values), flags);
}

[[nodiscard]] inline std::string compressed(const std::string& variable) {
  uLongf size = compressBound(variable.size());
  std::string data(size, '\0');
  compress(reinterpret_cast<Bytef*>(data.data()), &size,
           reinterpret_cast<const Bytef*>(variable.data()), variable.size());
  data.resize(size);
  return number(std::uint32_t{15}) + number(static_cast<std::uint32_t>(size)) + data;
}
}  // namespace pillarfield::io_test::mat

namespace pillarfield {
namespace {

// NOLINTNEXTLINE(google-build-using-namespace): tests of these files
using namespace io_test;

/// Reading of frame, row and column, from 0 to 119.
int mat_reading(int frame, int row, int column) { return 30 * frame + 7 * row + column; }

constexpr int kMatFrames = 3;
constexpr int kMatRows = 4;
constexpr int kMatColumns = 6;

/// The readings with the axes in the order of MATLAB's size(): the first varies fastest.
template <class Number>
std::vector<Number> by_columns(const std::vector<ArrayAxis>& axes) {
  const auto size = [](ArrayAxis axis) {
    return axis == ArrayAxis::frames ? kMatFrames
           : axis == ArrayAxis::rows ? kMatRows
                                     : kMatColumns;
  };
  std::vector<Number> values;
  std::array<int, 3> at{};  // frame, row, column
  const auto index = [&](std::size_t axis) -> int& {
    return at[static_cast<std::size_t>(axes[axis])];
  };
  for (index(2) = 0; index(2) < size(axes[2]); ++index(2)) {
    for (index(1) = 0; index(1) < size(axes[1]); ++index(1)) {
      for (index(0) = 0; index(0) < size(axes[0]); ++index(0)) {
        values.push_back(static_cast<Number>(mat_reading(at[0], at[1], at[2])));
      }
    }
  }
  return values;
}

std::vector<float> expected_readings() {
  std::vector<float> expected;
  for (int frame = 0; frame < kMatFrames; ++frame) {
    for (int row = 0; row < kMatRows; ++row) {
      for (int column = 0; column < kMatColumns; ++column) {
        expected.push_back(static_cast<float>(mat_reading(frame, row, column)));
      }
    }
  }
  return expected;
}

const std::vector<ArrayAxis> kTimeLastAxes = {ArrayAxis::rows, ArrayAxis::columns,
                                              ArrayAxis::frames};
const std::vector<std::int32_t> kTimeLastShape = {kMatRows, kMatColumns, kMatFrames};

ReadOptions time_last(const std::string& dataset = {}) {
  return {.dataset = dataset, .axes = kTimeLastAxes, .untimed = true};
}

class MatFileTest : public testing::Test {
 protected:
  std::unique_ptr<FrameSource> open(const std::string& variables,
                                    const ReadOptions& options = time_last()) {
    write_bytes(path_, mat::header() + variables);
    return open_frames(path_, options);
  }
  std::string refused(const std::string& variables, const ReadOptions& options = time_last()) {
    return error_of([&] { (void)open(variables, options); });
  }

  template <class Number>
  std::string pad(const std::string& name, mat::MxClass kind = mat::MxClass::real64) {
    return mat::array(kind, kTimeLastShape, name, by_columns<Number>(kTimeLastAxes));
  }

  template <class Number>
  void expect_read(mat::MxClass kind, SenselType type) {
    const std::string variable = pad<Number>("raw", kind);
    for (const std::string& stored : {variable, mat::compressed(variable)}) {
      SCOPED_TRACE(testing::Message()
                   << "class " << static_cast<int>(kind) << ", type " << mat::mi_type<Number>()
                   << ", " << stored.size() << " bytes");
      const auto source = open(stored);
      EXPECT_EQ(source->sensel_type(), type);
      EXPECT_EQ(source->frames(), kMatFrames);
      EXPECT_EQ(all_readings(*source), expected_readings());
    }
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "pads.mat";
};

TEST_F(MatFileTest, ClassesAreRead) {
  using enum SenselType;
  expect_read<std::uint8_t>(mat::MxClass::uint8, u8);
  expect_read<std::uint16_t>(mat::MxClass::uint16, u16);
  expect_read<std::int16_t>(mat::MxClass::int16, f32);
  expect_read<float>(mat::MxClass::real32, f32);
  expect_read<double>(mat::MxClass::real64, f32);
  expect_read<std::uint8_t>(mat::MxClass::real64, u8);  // MATLAB stores it in the shortest type.
}

TEST_F(MatFileTest, AxesAreInTheOrderOfMatlab) {
  for (const char* const words :
       {"frames,rows,columns", "rows,columns,frames", "columns,rows,frames", "rows,frames,columns",
        "columns,frames,rows", "frames,columns,rows"}) {
    SCOPED_TRACE(words);
    const std::vector<ArrayAxis> axes = parse_axes(words);
    std::vector<std::int32_t> shape;
    shape.reserve(axes.size());
    for (const ArrayAxis axis : axes) {
      shape.push_back(axis == ArrayAxis::frames ? kMatFrames
                      : axis == ArrayAxis::rows ? kMatRows
                                                : kMatColumns);
    }
    const std::string variable =
        mat::array(mat::MxClass::int16, shape, "raw", by_columns<std::int16_t>(axes));
    for (const std::string& stored : {variable, mat::compressed(variable)}) {
      EXPECT_EQ(all_readings(*open(stored, {.axes = axes, .untimed = true})), expected_readings());
    }
  }
}

TEST_F(MatFileTest, APlaneIsAFrameOrAFrameALine) {
  std::vector<float> first = expected_readings();
  first.resize(std::size_t{kMatRows} * kMatColumns);
  std::vector<std::uint8_t> plane;
  std::vector<std::uint8_t> lines;
  for (int column = 0; column < kMatColumns; ++column) {
    for (int row = 0; row < kMatRows; ++row) {
      plane.push_back(static_cast<std::uint8_t>(mat_reading(0, row, column)));
    }
  }
  for (int sensel = 0; sensel < kMatRows * kMatColumns; ++sensel) {
    for (int frame = 0; frame < kMatFrames; ++frame) {
      lines.push_back(static_cast<std::uint8_t>(
          mat_reading(frame, sensel / kMatColumns, sensel % kMatColumns)));
    }
  }
  const auto frame = open(mat::array(mat::MxClass::real64, {kMatRows, kMatColumns}, "raw", plane),
                          {.axes = parse_axes("rows,columns")});
  EXPECT_EQ(all_readings(*frame), first);
  const std::string variable =
      mat::array(mat::MxClass::real64, {kMatFrames, kMatRows * kMatColumns}, "raw", lines);
  const auto frames =
      open(variable, {.frame_size = FrameSize{kMatRows, kMatColumns}, .untimed = true});
  EXPECT_EQ(all_readings(*frames), expected_readings());
}

TEST_F(MatFileTest, TheOnlyArrayOfThreeAxesIsTakenAndTimeRead) {
  const std::string others =
      mat::array(mat::MxClass::real64, {1, 1}, "k", std::vector<double>{3.5}) +
      mat::array(mat::MxClass::real64, {kMatFrames, 1}, "time", std::vector<double>{0, 0.5, 0.75}) +
      mat::array(mat::MxClass::real64, {1, kMatFrames}, "t", std::vector<std::uint8_t>{4, 6, 9}) +
      mat::matrix(mat::MxClass::text, {1, 2}, "note", mat::element(4, std::string(4, 'a'))) +
      mat::array(mat::MxClass::real64, {0, 0}, "none", std::vector<double>{}) +
      mat::array(mat::MxClass::real64, {2, 2}, "plane", std::vector<double>{1, 2, 3, 4});
  const auto source =
      open(others + mat::compressed(pad<std::uint8_t>("raw")), {.axes = kTimeLastAxes});
  EXPECT_EQ(all_readings(*source), expected_readings());
  EXPECT_EQ(source->time(2), 0.75);
  const auto named = open(others + pad<float>("raw"), {.times = "t", .axes = kTimeLastAxes});
  EXPECT_EQ(named->time(1), 6);
  EXPECT_TRUE(has_all(refused(others + pad<float>("raw") + pad<float>("second")),
                      {"pads.mat", "several arrays: raw, second", "--dataset"}));
  EXPECT_TRUE(has_all(refused(others, time_last("raw")), {"no array 'raw'", "k, time, t, plane"}));
  EXPECT_TRUE(has_all(refused(others, time_last("note")), {"note is a text"}));
  EXPECT_TRUE(has_all(refused(others, time_last("k")), {"k: has the shape 1"}));
}

TEST_F(MatFileTest, CellsAndFieldsAreNamedAsInMatlab) {
  std::string field_names =
      std::string("raw") + std::string(5, '\0') + "mask" + std::string(4, '\0');
  const std::string fields =
      mat::numbers(std::vector<std::int32_t>{8}) + mat::element(1, field_names);
  const std::string small =
      mat::array(mat::MxClass::real64, {2, 2}, "", std::vector<float>{1, 2, 3, 4});
  const std::string cells = mat::matrix(mat::MxClass::cell, {1, 3}, "pads",
                                        small + mat::element(14, "") + pad<std::uint16_t>(""));
  const std::string log =
      mat::matrix(mat::MxClass::structure, {1, 1}, "log", fields + pad<std::int8_t>("") + small);
  const std::string logs = mat::matrix(mat::MxClass::structure, {2, 1}, "logs",
                                       fields + small + small + pad<float>("") + small);
  const std::string nested = mat::matrix(
      mat::MxClass::cell, {1, 1}, "deep",
      mat::matrix(mat::MxClass::structure, {1, 1}, "", fields + pad<double>("") + small));
  const std::string all = cells + mat::compressed(log) + logs + mat::compressed(nested);
  for (const char* const name : {"pads{3}", "log.raw", "logs(2).raw", "deep{1}.raw"}) {
    SCOPED_TRACE(name);
    EXPECT_EQ(all_readings(*open(all, time_last(name))), expected_readings());
  }
  EXPECT_TRUE(has_all(refused(all), {"pads{3}, log.raw, logs(2).raw, deep{1}.raw"}));
  EXPECT_EQ(all_readings(*open(mat::compressed(cells))), expected_readings());
}

TEST_F(MatFileTest, OtherValuesAreNamedWhereTheyAreAsked) {
  const auto values = by_columns<double>(kTimeLastAxes);
  const std::string two = mat::numbers(values) + mat::numbers(values);
  const std::string all =
      mat::matrix(mat::MxClass::real64, kTimeLastShape, "z", two, mat::kMxComplex) +
      mat::matrix(mat::MxClass::sparse, {4, 4}, "s", mat::numbers(values));
  EXPECT_TRUE(has_all(refused(all, time_last("z")), {"z is complex"}));
  EXPECT_TRUE(has_all(refused(all), {"no array of frames", "z is complex", "s is sparse"}));
  EXPECT_EQ(all_readings(*open(all + pad<double>("raw"))), expected_readings());
}

TEST_F(MatFileTest, HostileClaimsAreRefused) {
  const std::vector<std::uint8_t> few(8);
  const auto claimed = [&](const std::vector<std::int32_t>& shape) {
    return mat::array(mat::MxClass::uint8, shape, "raw", few);
  };
  for (const auto& shape :
       std::vector<std::vector<std::int32_t>>{{2, 2, 3},
                                              {2147483647, 2147483647, 2147483647},
                                              {-1, 2, 4},
                                              {1 << 16, 1 << 16, 1 << 16, 0}}) {
    for (const std::string& stored : {claimed(shape), mat::compressed(claimed(shape))}) {
      EXPECT_TRUE(has_all(refused(stored), {"pads.mat", "damaged or truncated"}));
    }
  }
  const std::string endless = mat::matrix(mat::MxClass::cell, {2147483647, 1}, "c", "");
  EXPECT_TRUE(has_all(refused(endless), {"c has 2147483647 elements"}));
  std::string many;
  for (int variable = 0; variable < 1001; ++variable) many += claimed({2, 4});
  EXPECT_TRUE(has_all(refused(many), {"more than 1000 variables"}));
  EXPECT_NE(refused(mat::number(std::uint32_t{15}) + mat::number(0xffffffffU)), "");
  EXPECT_NE(refused(""), "");
}

TEST_F(MatFileTest, ACompressedVariableIsNoLargerThanItCanBe) {
  const std::uint32_t length = 3U << 29U;
  const std::string content = mat::number(std::uint32_t{2}) + mat::number(length);
  const std::string variable =
      mat::matrix(mat::MxClass::uint8, {3, 1 << 14, 1 << 15}, "raw", content).substr(8);
  const std::string tag = mat::number(std::uint32_t{14}) +
                          mat::number(static_cast<std::uint32_t>(variable.size()) + length);
  EXPECT_TRUE(has_all(refused(mat::compressed(tag + variable)), {"raw", "smaller than any"}));
  EXPECT_TRUE(has_all(refused(tag + variable), {"ends within"}));
}

TEST_F(MatFileTest, AChangedByteOfACompressedVariableChangesNoReading) {
  const std::string stored = mat::compressed(pad<std::uint8_t>("raw"));
  for (std::size_t at = 10; at < stored.size(); ++at) {
    SCOPED_TRACE(at);
    std::string damaged = stored;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x10);
    try {  // The last bits of the compressed bytes mean nothing.
      EXPECT_EQ(all_readings(*open(damaged)), expected_readings());
    } catch (const Error& error) {
      EXPECT_TRUE(has_all(error.what(), {"pads.mat"}));
    }
  }
}

TEST_F(MatFileTest, TruncatedAndChangedFilesEndInAnError) {
  const std::string variable = pad<std::int16_t>("raw");
  const auto read = [&](const auto& path) {
    const auto source = open_frames(path, time_last());
    if (source->skin().sensels() > 10000 || source->frames() > 1000) return;
    (void)all_readings(*source);
  };
  for (const std::string& stored : {variable, mat::compressed(variable)}) {
    const std::string whole = mat::header() + stored;
    read_changed(path_, whole, 100, read);
    for (std::size_t size = 0; size < whole.size(); size += 3) {
      write_bytes(path_, whole.substr(0, size));
      EXPECT_NE(error_of([&] { (void)open_frames(path_, time_last()); }), "") << size;
    }
  }
}

TEST_F(MatFileTest, Version4IsRefusedInWords) {
  std::string old;
  for (const std::uint32_t word : {0U, 2U, 3U, 0U, 4U}) old += mat::number(word);
  write_bytes(path_, old + std::string("raw\0", 4) + std::string(48, '\0'));
  EXPECT_TRUE(
      has_all(error_of([&] { (void)open_frames(path_); }), {"pads.mat", "version 4", "-v7"}));
}

/// A hand of Schunk that closes on a bottle: Drimus et al., Robotics and Autonomous Systems 2012;
/// Madry et al., ICRA 2014.
TEST(MatFile, ReadsARealRecordingAsItsCopyInNumPy) {
  const std::filesystem::path folder = std::filesystem::path(PILLARFIELD_TEST_DATA) / "real";
  if (!std::filesystem::exists(folder / "schunk_balsam.mat")) GTEST_SKIP();
  for (const auto& [element, copy] : {std::pair("TS{1}", "schunk_balsam_proximal1.npy"),
                                      std::pair("TS{2}", "schunk_balsam_distal1.npy")}) {
    SCOPED_TRACE(element);
    const auto read = open_frames(folder / "schunk_balsam.mat", time_last(element));
    const auto expected = open_frames(folder / copy, {.untimed = true});
    EXPECT_EQ(read->notes(), expected->notes());
    EXPECT_EQ(all_readings(*read), all_readings(*expected));
  }
}

}  // namespace
}  // namespace pillarfield
