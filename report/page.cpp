#include "report/page.h"

#include <fstream>

#include "pillarfield/error.h"

namespace pillarfield::report {

void write_page(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw Error(path.string(), "cannot be written", "check the folder and the disk");
}

}  // namespace pillarfield::report
