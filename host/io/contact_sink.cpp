#include "io/contact_sink.h"

#include <fmt/format.h>

#include <cmath>

#include "io/ending.h"
#include "pillarfield/error.h"

namespace pillarfield {

void check(const FrameContacts& frame, const std::filesystem::path& path) {
  if (std::isfinite(frame.time_s)) return;
  throw Error(path.string(), fmt::format("its time is {}", frame.time_s), "give seconds");
}

std::unique_ptr<ContactSink> create_contact_sink(const std::filesystem::path& path,
                                                 const ContactFileInfo& info, Replace replace) {
  return kind_of_contact_file(path) == OutputKind::contact_table
             ? create_contact_csv_sink(path, info, replace)
             : create_contact_json_sink(path, info, replace);
}

OutputKind kind_of_contact_file(const std::filesystem::path& path) {
  const std::string ending = ending_of(path);
  if (ending == ".csv") return OutputKind::contact_table;
  if (ending == ".json") return OutputKind::contact_list;
  throw Error(path.string(), "its ending names no table of contacts", "end it in .csv or .json");
}

}  // namespace pillarfield
