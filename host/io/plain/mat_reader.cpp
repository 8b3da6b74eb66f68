#include "io/plain/mat_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "base/npy.h"
#include "pillarfield/error.h"

namespace pillarfield {

MatReader::MatReader(const InputFile& file, const MatVariable& variable, bool is_swapped,
                     std::uint64_t& budget)
    : file_(file), variable_(variable), is_swapped_(is_swapped), budget_(budget) {
  if (!variable.is_compressed) return;
  inflater_.emplace(
      file, DeflatedData{.at = variable.at, .bytes = variable.bytes, .has_zlib_header = true},
      file.path().string(), kDamagedMat);
}

void MatReader::read(std::span<std::byte> bytes) {
  if (inflater_) {
    if (bytes.size() > budget_) {
      throw Error(
          file_.path().string(),
          fmt::format("its variables inflate to more than {} bytes", most_inflated(file_.size())),
          "save the frames alone, with -v6 or -v7.3");
    }
    budget_ -= bytes.size();
    if (inflater_->read(bytes) != bytes.size()) fail("ends within a variable");
  } else {
    if (bytes.size() > variable_.bytes - at_) fail("ends within a variable");
    file_.read(variable_.at + at_, bytes);
  }
  at_ += bytes.size();
}

void MatReader::skip_to(std::uint64_t at) {
  if (at < at_) fail("has an element that is longer than what it is part of");
  if (!inflater_) {
    if (at > variable_.bytes) fail("ends within a variable");
    at_ = at;
    return;
  }
  std::vector<std::byte> skipped(std::size_t{64} << 10U);
  while (at_ < at)
    read(std::span(skipped).first(std::min<std::uint64_t>(skipped.size(), at - at_)));
}

void MatReader::finish() {
  std::vector<std::byte> rest(std::size_t{64} << 10U);
  std::size_t found = rest.size();
  while (inflater_ && found == rest.size()) {
    found = inflater_->read(rest);
    if (found > budget_) fail("has a variable that is longer than its length");
    budget_ -= found;
  }
}

MatTag MatReader::tag() {
  std::array<char, 8> bytes{};
  read(std::as_writable_bytes(std::span(bytes)));
  const std::uint32_t first = number(bytes.data());
  MatTag tag = {.type = MatType{first & 0xffffU}, .bytes = first >> 16U};
  tag.is_small = tag.bytes != 0;
  if (!tag.is_small) {
    tag.bytes = number(&bytes[4]);
  } else if (tag.bytes > tag.small.size()) {
    fail(fmt::format("has an element of type {}", first));
  }
  std::memcpy(tag.small.data(), &bytes[4], tag.small.size());
  return tag;
}

std::string MatReader::data(MatType type, std::uint64_t most) {
  const MatTag found = tag();
  if (found.type != type || found.bytes > most) {
    fail(fmt::format("has an element of type {} and {} bytes where type {} is due",
                     static_cast<std::uint32_t>(found.type), found.bytes,
                     static_cast<std::uint32_t>(type)));
  }
  std::string bytes(found.bytes, '\0');
  if (found.is_small) {
    std::memcpy(bytes.data(), found.small.data(), bytes.size());
    return bytes;
  }
  read(std::as_writable_bytes(std::span(bytes)));
  skip_to((at_ + 7) / 8 * 8);
  return bytes;
}

std::uint32_t MatReader::number(const char* bytes) const {
  std::array<std::byte, 4> copy{};
  std::memcpy(copy.data(), bytes, copy.size());
  if (is_swapped_) swap_bytes(copy.data(), 1, copy.size());
  return number_at<std::uint32_t>(copy.data(), 0);
}

void MatReader::fail(const std::string& failure) const {
  throw Error(file_.path().string(), failure, kDamagedMat);
}

}  // namespace pillarfield
