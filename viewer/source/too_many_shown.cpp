#include "viewer/source/too_many_shown.h"

#include <fmt/format.h>

#include "pillarfield/error.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

void throw_too_many_shown() {
  throw Error("FieldProducer",
              fmt::format("{} fields are in use, as many as there are", FieldProducer::kMostShown),
              "let one go before another is produced");
}

}  // namespace pillarfield::viewer
