#pragma once

#include <map>
#include <string>
#include <string_view>

namespace sidestep {

/// A text whose every `{{name}}` is replaced by the part of that name. Parts are put in as they
/// are, and not searched for further names.
/// @throws std::invalid_argument for a name without a part, or a part that no name asks for.
std::string FillTemplate(std::string_view text,
                         const std::map<std::string, std::string, std::less<>>& parts);

/// JSON as it can stand in a `<script type="application/json">` of a page, whatever its texts hold:
/// none of them can end the element. It means the same JSON.
std::string ScriptJson(std::string_view json);

}  // namespace sidestep
