#pragma once

#include <string>
#include <string_view>

namespace sidestep {

/// Text as XML and HTML take it, between tags and in attributes within double quotes: `&`, `<`, `>`
/// and `"` written out.
std::string EscapeMarkup(std::string_view text);

}  // namespace sidestep
