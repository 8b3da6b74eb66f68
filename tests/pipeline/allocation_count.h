#pragma once

#include <cstdint>

namespace pillarfield::pipeline_test {

/// How often the program has asked operator new for memory. Linking this file replaces it.
[[nodiscard]] std::uint64_t allocations();

}  // namespace pillarfield::pipeline_test
