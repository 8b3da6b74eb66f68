#pragma once

#include <string_view>
#include <vector>

namespace pillarfield {

/// A file of kernels/, embedded in the library.
struct KernelFile {
  std::string_view name;  ///< relative to kernels/
  std::string_view text;
};

/// All of them in the order in which they form one program (kernels/CMakeLists.txt).
std::vector<KernelFile> kernel_files();

}  // namespace pillarfield
