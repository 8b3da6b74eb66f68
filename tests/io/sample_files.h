#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "pillarfield/error.h"
#include "pillarfield/force_field.h"
#include "pillarfield/frame.h"
#include "pillarfield/skin.h"

namespace pillarfield::io_test {

/// A temporary directory, removed with its content.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string pattern = (std::filesystem::temp_directory_path() / "pillarfield-XXXXXX").string();
    if (mkdtemp(pattern.data()) != nullptr) path_ = pattern;
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      found.push_back(entry.path().filename().string());
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  std::filesystem::path path_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// A pseudo-random number of `frame` and `place` (splitmix64).
inline std::uint64_t number_at(std::uint64_t frame, std::uint64_t place) {
  std::uint64_t mixed = frame * 0x100000001b3u + place + 0x9e3779b97f4a7c15u;
  mixed = (mixed ^ (mixed >> 30)) * 0xbf58476d1ce4e5b9u;
  mixed = (mixed ^ (mixed >> 27)) * 0x94d049bb133111ebu;
  return mixed ^ (mixed >> 31);
}

/// Fills a frame of any type with arbitrary bits; floats are finite.
inline void fill_frame(std::uint64_t index, FrameBuffer& frame) {
  const FrameView view = frame.view();
  if (view.type == SenselType::f32) {
    std::uint64_t place = 0;
    for (float& reading : frame.readings<float>()) {
      reading = static_cast<float>(number_at(index, place++)) * 1e-9f;
    }
    return;
  }
  std::uint64_t place = 0;
  for (std::byte& byte : frame.bytes()) byte = std::byte(number_at(index, place++) & 0xff);
}

inline ForceField sample_forces(std::uint64_t index, std::uint32_t rows, std::uint32_t cols) {
  ForceField forces(rows, cols);
  const auto value = [&](std::uint64_t place) {
    return static_cast<float>(static_cast<double>(number_at(index, place)) * 1e-20 - 0.1);
  };
  for (std::size_t pillar = 0; pillar < forces.elements(); ++pillar) {
    forces.shear_x[pillar] = value(4 * pillar);
    forces.shear_y[pillar] = value(4 * pillar + 1);
    forces.normal[pillar] = value(4 * pillar + 2);
    forces.status[pillar] = static_cast<std::uint8_t>(number_at(index, 4 * pillar + 3) % 7);
  }
  return forces;
}

/// The text of the Error that `action` throws; fails the test if it throws none or the text is not
/// one line.
template <class Action>
std::string error_of(Action action) {
  try {
    action();
  } catch (const Error& error) {
    std::string text = error.what();
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    return text;
  }
  ADD_FAILURE() << "no Error was thrown";
  return {};
}

/// Succeeds if `text` contains all of `parts`.
inline ::testing::AssertionResult has_all(const std::string& text,
                                          const std::vector<std::string>& parts) {
  for (const auto& part : parts) {
    if (text.find(part) == std::string::npos) {
      return ::testing::AssertionFailure() << "'" << part << "' is not in '" << text << "'";
    }
  }
  return ::testing::AssertionSuccess();
}

}  // namespace pillarfield::io_test
