#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/number_text.h"
#include "base/utf8.h"
#include "io/force_format.h"
#include "io/force_sink.h"
#include "io/output/text_part.h"
#include "pillarfield/contact_columns.h"

namespace pillarfield {
namespace {

/// A JSON string with its quotes; a byte that is not UTF-8 becomes the replacement character.
std::string json_string(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto code = static_cast<unsigned char>(text.front());
    if (length == 0) {
      json += "\xef\xbf\xbd";
    } else if (code == '"' || code == '\\') {
      json += '\\';
      json += text.front();
    } else if (code < 0x20) {
      json += fmt::format("\\u{:04x}", code);
    } else {
      json += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return json + '"';
}

/// `"name":value` for each column, separated by commas.
template <class Row>
std::string members_of(std::span<const ContactColumn<Row>> columns, const Row& row,
                       const PressureUnit& unit) {
  std::string members;
  for (const auto& column : columns) {
    std::string value = text_of(column, row, "null", unit);
    const bool is_word = column.kind == ColumnKind::word;
    if (column.kind == ColumnKind::number && value.find_first_of(".en") == std::string::npos) {
      value += ".0";
    }
    members += fmt::format("{}\"{}\":{}", members.empty() ? "" : ",", name_of(column, unit),
                           is_word ? json_string(value) : value);
  }
  return members;
}

constexpr std::string_view kContactJsonHead = R"({"format":"pillarfield-contacts")";

/// Writes one object with a line per frame.
class JsonSink final : public ForceSink {
 public:
  JsonSink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace);

  void append(const SolvedFrame& frame) override;
  void finish() override;

 private:
  std::filesystem::path path_;
  TextPart file_;
  QuantityColumns columns_;
  PressureUnit unit_;
  std::uint64_t frames_ = 0;
};

JsonSink::JsonSink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace)
    : path_(path),
      file_(path, OutputKind::contacts, replace),
      columns_(quantity_columns(info.contacts.value_or(ContactOptions{}))),
      unit_(info.pressure_unit) {
  const ContactOptions& options = info.contacts.value();
  const auto& friction = options.friction.given;
  const Pitch& pitch = info.element_pitch_mm;
  file_.write(fmt::format(
      "{},\"version\":1,\"source\":{},"
      "\"{}\":{},\"minimum_pillars\":{},\"given_friction\":{},"
      "\"reach_mm\":{},\"frames\":[",
      kContactJsonHead, json_string(info.source), force_format::pitch_of(info.layout),
      pitch.is_square()
          ? json_number(pitch.col_mm)
          : fmt::format("[{},{}]", json_number(pitch.row_mm), json_number(pitch.col_mm)),
      options.minimum_pillars, friction ? json_number(*friction) : "null",
      json_number(options.reach_mm)));
}

void JsonSink::append(const SolvedFrame& frame) {
  file_.require_open();
  const std::string where = path_.string();
  const FrameContacts& found = contacts_of(frame, where);
  file_.write(fmt::format("{}\n{{\"frame\":{},\"time_s\":{},\"patch\":{{{}}},\"contacts\":[",
                          frames_ == 0 ? "" : ",", frames_, json_number(frame.time_s),
                          members_of(columns_, found.total, unit_)));
  const char* separator = "";
  for (const TrackedContact& contact : found.contacts) {
    file_.write(fmt::format("{}{{{},{}}}", separator,
                            members_of(identity_columns(), contact, unit_),
                            members_of(columns_, contact.quantities, unit_)));
    separator = ",";
  }
  file_.write("],\"ended\":[");
  separator = "";
  for (const EndedContact& contact : found.ended) {
    file_.write(fmt::format("{}{{{}}}", separator, members_of(ended_columns(), contact, unit_)));
    separator = ",";
  }
  file_.write("]}");
  ++frames_;
}

void JsonSink::finish() {
  file_.require_open();
  file_.write("\n]}\n");
  file_.finish();
}

}  // namespace

SinkFormat contact_json_format() {
  return {.kind = OutputKind::contacts,
          .extensions = {".json"},
          .content = "is a list of contacts",
          .begins = kContactJsonHead,
          .create = create_sink<JsonSink>};
}

}  // namespace pillarfield
