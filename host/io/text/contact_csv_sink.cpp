#include <fmt/format.h>

#include "io/force_sink.h"
#include "io/output/text_part.h"
#include "pillarfield/contact_columns.h"

namespace pillarfield {
namespace {

constexpr std::string_view kContactCsvHead =
    "row,frame,time_s,id,parent,merged_into,first_time_s,age_s";

/// Writes one line per frame for the patch, each contact and each ended contact.
class ContactCsvSink final : public ForceSink {
 public:
  ContactCsvSink(const std::filesystem::path& path, const ForceFileInfo& info, Replace replace);

  void append(const SolvedFrame& frame) override;
  void finish() override { file_.finish(); }

 private:
  void add_quantities(const ContactQuantities& quantities);
  void add_contact(const TrackedContact& contact);
  void add_ended(const EndedContact& contact);

  std::filesystem::path path_;
  TextPart file_;
  QuantityColumns columns_;
  PressureUnit unit_;
  std::string frame_cells_;  // "frame,time,", shared by all lines of a frame
  std::uint64_t frames_ = 0;
};

ContactCsvSink::ContactCsvSink(const std::filesystem::path& path, const ForceFileInfo& info,
                               Replace replace)
    : path_(path),
      file_(path, OutputKind::contacts, replace),
      columns_(quantity_columns(info.contacts.value_or(ContactOptions{}))),
      unit_(info.pressure_unit) {
  file_.write(kContactCsvHead);
  for (const auto& column : columns_) file_.write(fmt::format(",{}", name_of(column, unit_)));
  file_.write("\n");
}

void ContactCsvSink::add_quantities(const ContactQuantities& quantities) {
  for (const auto& column : columns_) {
    file_.write(fmt::format(",{}", text_of(column, quantities, "", unit_)));
  }
  file_.write("\n");
}

void ContactCsvSink::add_contact(const TrackedContact& contact) {
  const std::string parent = contact.parent ? fmt::format("{}", *contact.parent) : "";
  file_.write(fmt::format("contact,{}{},{},,{},{}", frame_cells_, contact.track_id, parent,
                          contact.first_time_s, contact.age_s));
  add_quantities(contact.quantities);
}

void ContactCsvSink::add_ended(const EndedContact& contact) {
  const std::string merged = contact.merged_into ? fmt::format("{}", *contact.merged_into) : "";
  file_.write(fmt::format("ended,{}{},,{},{},{}", frame_cells_, contact.track_id, merged,
                          contact.first_time_s, contact.last_time_s - contact.first_time_s));
  file_.write(std::string(columns_.size(), ',') + "\n");
}

void ContactCsvSink::append(const SolvedFrame& frame) {
  file_.require_open();
  const std::string where = path_.string();
  const FrameContacts& found = contacts_of(frame, where);
  frame_cells_ = fmt::format("{},{},", frames_, frame.time_s);
  file_.write(fmt::format("patch,{},,,,", frame_cells_));
  add_quantities(found.total);
  for (const TrackedContact& contact : found.contacts) add_contact(contact);
  for (const EndedContact& contact : found.ended) add_ended(contact);
  ++frames_;
}

}  // namespace

SinkFormat contact_csv_format() {
  return {.kind = OutputKind::contacts,
          .extensions = {".csv"},
          .content = "is a table of contacts",
          .begins = kContactCsvHead,
          .create = create_sink<ContactCsvSink>};
}

}  // namespace pillarfield
