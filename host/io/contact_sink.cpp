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
                                                 const ContactFileInfo& info) {
  const std::string ending = ending_of(path);
  if (ending == ".csv") return create_contact_csv_sink(path, info);
  if (ending == ".json") return create_contact_json_sink(path, info);
  throw Error(path.string(), "its ending names no table of contacts", "end it in .csv or .json");
}

}  // namespace pillarfield
