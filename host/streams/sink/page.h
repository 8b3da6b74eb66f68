#pragma once

#include <string_view>

namespace pillarfield {

/// The page of the sink `web`, page.html, which the library embeds.
[[nodiscard]] std::string_view page_html();

}  // namespace pillarfield
