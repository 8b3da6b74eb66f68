#include <fmt/format.h>

#include "io/contact_columns.h"
#include "io/contact_sink.h"
#include "io/output/text_part.h"

namespace pillarfield {
namespace {

/// A line for the patch, for each contact and for each that ended.
class ContactCsvSink final : public ContactSink {
 public:
  ContactCsvSink(const std::filesystem::path& path, Replace replace);

  void append(const FrameContacts& frame) override;
  void finish() override { file_.finish(); }

 private:
  void add_quantities(const ContactQuantities& quantities);
  void add_contact(const TrackedContact& contact);
  void add_ended(const EndedContact& contact);

  std::filesystem::path path_;
  TextPart file_;
  std::string frame_cells_;  // "frame,time,", the same on each line of a frame
  std::uint64_t frames_ = 0;
};

ContactCsvSink::ContactCsvSink(const std::filesystem::path& path, Replace replace)
    : path_(path), file_(path, OutputKind::contact_table, replace) {
  file_.write("row,frame,time_s,id,parent,merged_into,first_time_s,age_s");
  for (const auto& column : quantity_columns()) file_.write(fmt::format(",{}", column.name));
  file_.write("\n");
}

void ContactCsvSink::add_quantities(const ContactQuantities& quantities) {
  for (const auto& column : quantity_columns()) {
    file_.write(fmt::format(",{}", text_of(column, quantities, "")));
  }
  file_.write("\n");
}

void ContactCsvSink::add_contact(const TrackedContact& contact) {
  const std::string parent = contact.parent ? fmt::format("{}", *contact.parent) : "";
  file_.write(fmt::format("contact,{}{},{},,{},{}", frame_cells_, contact.id, parent,
                          contact.first_time_s, contact.age_s));
  add_quantities(contact.quantities);
}

void ContactCsvSink::add_ended(const EndedContact& contact) {
  const std::string merged = contact.merged_into ? fmt::format("{}", *contact.merged_into) : "";
  file_.write(fmt::format("ended,{}{},,{},{},{}", frame_cells_, contact.id, merged,
                          contact.first_time_s, contact.last_time_s - contact.first_time_s));
  file_.write(std::string(quantity_columns().size(), ',') + "\n");
}

void ContactCsvSink::append(const FrameContacts& frame) {
  file_.require_open();
  check(frame, path_);
  frame_cells_ = fmt::format("{},{},", frames_, frame.time_s);
  file_.write(fmt::format("patch,{},,,,", frame_cells_));
  add_quantities(frame.patch);
  for (const TrackedContact& contact : frame.contacts) add_contact(contact);
  for (const EndedContact& contact : frame.ended) add_ended(contact);
  ++frames_;
}

}  // namespace

std::unique_ptr<ContactSink> create_contact_csv_sink(const std::filesystem::path& path,
                                                     const ContactFileInfo& /*info*/,
                                                     Replace replace) {
  return std::make_unique<ContactCsvSink>(path, replace);
}

}  // namespace pillarfield
