#pragma once

#include <string>
#include <string_view>

#include "sidestep/core/input_error.h"

namespace sidestep {

/// Text as XML and HTML take it, between tags and in attributes within double quotes: `&`, `<`, `>`
/// and `"` written out.
std::string EscapeMarkup(std::string_view text);

/// What is wrong with a file that is no XML, as TinyXML-2 names it ("XML_ERROR_MISMATCHED_ELEMENT")
/// and its line; 0 where it has none.
InputError XmlFault(const std::string& path, int line, std::string_view name);

}  // namespace sidestep
