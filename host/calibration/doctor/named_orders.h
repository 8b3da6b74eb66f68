#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace pillarfield {

/// A frequent fault of wiring.
struct NamedOrder {
  std::string name;                  ///< "8 to 15 are mirrored", after "Rows" or "Columns"
  std::vector<std::uint32_t> order;  ///< the lines as they lie
};

/// The frequent faults of `lines` lines in which `first` to `last` are out of place: these, or some
/// more beside them, are mirrored or in two swapped parts; two are swapped; the halves are
/// interleaved.
[[nodiscard]] std::vector<NamedOrder> named_orders(std::uint32_t lines, std::uint32_t first,
                                                   std::uint32_t last);

}  // namespace pillarfield
