#pragma once

#include <cstdint>

namespace pillarfield::pipeline_test {

/// Number of calls of operator new, which linking this file replaces.
[[nodiscard]] std::uint64_t allocations();

}  // namespace pillarfield::pipeline_test
