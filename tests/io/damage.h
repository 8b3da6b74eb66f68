#pragma once

// Damage of files: edits by calls of HDF5, cut files and changed bytes. A reader refuses what is
// damaged in one line that names the file, or reads it; it never crashes.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "pillarfield/recording.h"
#include "tests/io/sample_files.h"

namespace pillarfield::io_test {

inline void edit(const std::filesystem::path& path, const std::function<void(hid_t)>& action) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  action(file);
  ASSERT_GE(H5Fclose(file), 0);
}

/// Sets or replaces an attribute of one value of the type.
inline void set_attribute(hid_t file, const char* object, const char* name, hid_t stored,
                          hid_t memory, const void* value) {
  if (H5Aexists_by_name(file, object, name, H5P_DEFAULT) > 0) {
    H5Adelete_by_name(file, object, name, H5P_DEFAULT);
  }
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute =
      H5Acreate_by_name(file, object, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, memory, value);
  H5Aclose(attribute);
  H5Sclose(space);
}

inline void set_number(hid_t file, const char* object, const char* name, double value) {
  set_attribute(file, object, name, H5T_IEEE_F64BE, H5T_NATIVE_DOUBLE, &value);
}

inline void set_text(hid_t file, const char* object, const char* name, const std::string& value,
                     bool variable = false) {
  const char* const text = value.c_str();
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, variable ? H5T_VARIABLE : value.size());
  set_attribute(file, object, name, type, type,
                variable ? static_cast<const void*>(&text) : static_cast<const void*>(text));
  H5Tclose(type);
}

inline void remove_link(hid_t file, const char* name) { H5Ldelete(file, name, H5P_DEFAULT); }

inline void remove_attribute(hid_t file, const char* object, const char* name) {
  H5Adelete_by_name(file, object, name, H5P_DEFAULT);
}

/// An edit, and words of the error in which it must end.
struct Damage {
  const char* name;
  std::function<void(hid_t)> action;
  std::vector<std::string> message;
};

/// Each damage to a new file that `write` writes to `path` ends in one error of `read`.
template <class Write, class Read>
void expect_refused(const std::filesystem::path& path, std::span<const Damage> damages, Write write,
                    Read read) {
  for (const Damage& damage : damages) {
    SCOPED_TRACE(damage.name);
    std::filesystem::remove(path);
    write(path);
    edit(path, damage.action);
    const std::string error = error_of([&] { read(path); });
    EXPECT_TRUE(has_all(error, {path.string()}));
    EXPECT_TRUE(has_all(error, damage.message));
  }
}

/// `read` takes a file of these bytes, or refuses it by its name.
template <class Read>
void read_or_refuse(const std::filesystem::path& path, const std::string& bytes, Read read) {
  write_bytes(path, bytes);
  try {
    read(path);
  } catch (const Error& error) {
    EXPECT_TRUE(has_all(error.what(), {path.filename().string()}));
  }
}

/// Reads the first 0 to `parts` - 1 of `parts` parts of a file.
template <class Read>
void read_cut(const std::filesystem::path& path, const std::string& whole, std::size_t parts,
              Read read) {
  for (std::size_t part = 0; part < parts; ++part) {
    SCOPED_TRACE(testing::Message() << part << " of " << parts << " parts");
    read_or_refuse(path, whole.substr(0, whole.size() * part / parts), read);
  }
}

/// The bytes with one to three changed.
inline std::string changed(std::string bytes, std::uint64_t trial) {
  for (std::uint64_t place = 0; place <= trial % 3; ++place) {
    const std::size_t at = number_at(trial, 2 * place) % bytes.size();
    bytes[at] = static_cast<char>(number_at(trial, 2 * place + 1));
  }
  return bytes;
}

/// Reads `trials` copies of a file with one to three changed bytes.
template <class Read>
void read_changed(const std::filesystem::path& path, const std::string& whole, std::uint64_t trials,
                  Read read) {
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    read_or_refuse(path, changed(whole, trial), read);
  }
}

/// The readings of all frames as floats.
inline std::vector<float> all_readings(FrameSource& source) {
  std::vector<float> all;
  FrameBuffer frame(source.sensel_type(), source.skin().rows, source.skin().cols);
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    source.read(index, frame);
    const auto append = [&](const auto& readings) {
      for (const auto reading : readings) all.push_back(static_cast<float>(reading));
    };
    if (source.sensel_type() == SenselType::u8) append(frame.readings<std::uint8_t>());
    if (source.sensel_type() == SenselType::u16) append(frame.readings<std::uint16_t>());
    if (source.sensel_type() == SenselType::f32) append(frame.readings<float>());
  }
  return all;
}

inline std::vector<double> times_of(FrameSource& source) {
  std::vector<double> times_s;
  for (std::uint64_t index = 0; index < source.frames(); ++index) {
    times_s.push_back(source.time(index));
  }
  return times_s;
}

}  // namespace pillarfield::io_test
