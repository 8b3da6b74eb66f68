#pragma once

#include <span>
#include <string>
#include <string_view>

namespace pillarfield {

/// Reason why a server of this computer must not answer a WebSocket request with these headers;
/// empty if it may. Browsers let any page of the web connect, and say only by `Origin` which one.
///
/// `origin` may be absent (a program), "file://" (a program of web technology, or a page from the
/// disk; pages of the web never have it), a page of this computer, or one of `allowed`, such as
/// "https://app.foxglove.dev". `host` may be an IP address, localhost, the name of this computer,
/// or the host of an allowed origin; any other name that resolves to this computer (DNS rebinding)
/// is refused.
[[nodiscard]] std::string refusal_of(std::string_view origin, std::string_view host,
                                     std::span<const std::string> allowed);

/// The answer to a request that opens no WebSocket, and that ends the connection: `status` is such
/// as "404 Not Found", `type` that of the text. A page may load nothing, and be in no frame.
[[nodiscard]] std::string http_answer(std::string_view status, std::string_view type,
                                      std::string_view text);

}  // namespace pillarfield
