#include "cli/parts/examine.h"

#include "cli/progress.h"
#include "pillarfield/error.h"
#include "pillarfield/interrupt.h"

namespace pillarfield::cli {

std::vector<LostPart> examined_parts(const ForceFileReader& reader, const std::string& file,
                                     bool quiet) {
  Progress progress("Examining", reader.parts(), quiet, "part");
  return reader.examine_parts([&](std::uint64_t done, std::uint64_t /*all*/) {
    if (is_interrupted()) throw Error(file, "interrupted while its parts were examined");
    progress.show(done);
  });
}

}  // namespace pillarfield::cli
