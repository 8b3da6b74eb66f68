#include "base/number_type.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace pillarfield {

std::string name_of(NumberType type) {
  using Kind = NumberType::Kind;
  const char* const kind = type.kind == Kind::real             ? "float"
                           : type.kind == Kind::signed_integer ? "int"
                                                               : "uint";
  return fmt::format("{}{}", kind, 8 * type.bytes);
}

std::string text_of_shape(const std::vector<std::uint64_t>& shape) {
  return fmt::format("{}", fmt::join(shape, " x "));
}

std::vector<double> doubles_of(NumberType type, const std::vector<std::byte>& numbers) {
  std::vector<double> values(numbers.size() / type.bytes);
  with_number(type, [&]<class Number>(Number) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<double>(number_at<Number>(numbers.data(), i));
    }
  });
  return values;
}

}  // namespace pillarfield
