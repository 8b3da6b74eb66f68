#include "viewer/source/too_many_shown.h"

#include <fmt/format.h>

#include "pillarfield/error.h"
#include "viewer/source/field_producer.h"

namespace pillarfield::viewer {

void throw_too_many_shown() {
  throw Error("FieldProducer", fmt::format("all {} fields are in use", FieldProducer::kMostShown),
              "release one before producing another");
}

}  // namespace pillarfield::viewer
