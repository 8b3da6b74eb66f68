#include "report/page.h"

#include "pillarfield/output_file.h"

namespace pillarfield::report {

void write_page(const std::filesystem::path& path, const std::string& text) {
  OutputFile file(path, OutputKind::text, Replace::anything);
  file.write(text);
  file.commit();
}

}  // namespace pillarfield::report
