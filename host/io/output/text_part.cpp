#include "io/output/text_part.h"

#include "pillarfield/error.h"

namespace pillarfield {
namespace {

constexpr std::size_t kTextBlockBytes = 1 << 20;

}  // namespace

TextPart::TextPart(const std::filesystem::path& path, OutputKind kind, Replace replace)
    : file_(path, kind, replace) {}

void TextPart::write(std::string_view text) {
  text_.append(text);
  if (text_.size() < kTextBlockBytes) return;
  file_.write(std::string_view(text_.data(), text_.size()));
  text_.clear();
}

void TextPart::finish() {
  require_open();
  file_.write(std::string_view(text_.data(), text_.size()));
  text_.clear();
  file_.commit();
}

void TextPart::require_open() const {
  if (file_.is_open()) return;
  throw Error(file_.path().string(), "is finished", "start another file");
}

}  // namespace pillarfield
