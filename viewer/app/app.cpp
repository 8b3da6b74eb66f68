#include "viewer/app/app.h"

#include "pillarfield/error.h"

namespace pillarfield::viewer {

int run_window(const Options&) {
  throw Error("pillarfield-viewer", "there is no window yet", "render to a file: --headless");
}

}  // namespace pillarfield::viewer
