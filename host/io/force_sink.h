#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "pillarfield/force_file.h"

namespace pillarfield {

[[nodiscard]] std::unique_ptr<ForceSink> create_hdf5_sink(const std::filesystem::path& path,
                                                          const ForceFileInfo& info,
                                                          Replace replace);
[[nodiscard]] std::unique_ptr<ForceSink> create_csv_sink(const std::filesystem::path& path,
                                                         const ForceFileInfo& info,
                                                         Replace replace);
[[nodiscard]] std::unique_ptr<ForceSink> create_npy_sink(const std::filesystem::path& path,
                                                         const ForceFileInfo& info,
                                                         Replace replace);

/// Throws Error, its place being `where`, unless the frame is of the size and has the planes that
/// `info` names, and the time is finite.
void check(const ForceFieldView& forces, double time_s, const ForceFileInfo& info,
           const std::string& where);

}  // namespace pillarfield
