#include "tests/defined_types.h"

#include <cctype>
#include <cstddef>
#include <regex>
#include <utility>

namespace sidestep {
namespace {

struct Token {
  std::string text;
  int line = 0;
};

// Comments, literals and directives of the preprocessor, none of which hold a type's name.
const std::regex& Skipped() {
  static const std::regex skipped(
      R"re(R"(\w*)\([^]*?\)\1"|//[^\n]*|/\*[^]*?\*/)re"
      R"re(|"(\\.|[^"\\\n])*"|'(\\.|[^'\\\n])'|#[^\n]*(\\\n[^\n]*)*)re");
  return skipped;
}

std::vector<Token> Tokens(const std::string& text) {
  std::vector<Token> tokens;
  int line = 1;
  const auto read = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end;) {
      const auto is_word = [&](std::size_t at) {
        return at < end && (std::isalnum(static_cast<unsigned char>(text[at])) || text[at] == '_');
      };
      std::size_t length = 1;
      if (is_word(i)) {
        while (is_word(i + length)) ++length;
      } else if (text.compare(i, 2, "::") == 0) {
        length = 2;
      }
      if (text[i] == '\n') ++line;
      if (!std::isspace(static_cast<unsigned char>(text[i]))) {
        tokens.push_back({text.substr(i, length), line});
      }
      i += length;
    }
  };
  std::size_t done = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), Skipped()), end; it != end; ++it) {
    read(done, static_cast<std::size_t>(it->position()));
    for (const char c : it->str()) line += c == '\n';
    done = static_cast<std::size_t>(it->position() + it->length());
  }
  read(done, text.size());
  return tokens;
}

class Finder {
 public:
  explicit Finder(const std::string& text) : tokens_(Tokens(text)) {}

  std::vector<DefinedType> Run() {
    ReadNamespace("", /*is_visible=*/true);
    return std::move(found_);
  }

 private:
  bool Ends() const { return at_ >= tokens_.size(); }
  const std::string& Here() const { return tokens_[at_].text; }

  // Past a bracket and all up to the one that closes it.
  void Skip(const std::string& open, const std::string& close) {
    int depth = 0;
    for (; !Ends(); ++at_) {
      if (Here() == open) ++depth;
      if (Here() == close && --depth == 0) {
        ++at_;
        return;
      }
    }
  }

  // What stands between the braces of the namespace `prefix`.
  void ReadNamespace(const std::string& prefix, bool is_visible) {
    while (!Ends() && Here() != "}") {
      if (Here() == "namespace") {
        ++at_;
        std::string name;
        while (!Ends() && Here() != "{" && Here() != ";" && Here() != "=") {
          name += Here();
          ++at_;
        }
        if (Ends() || Here() != "{") continue;  // an alias, or `using namespace`
        ++at_;
        ReadNamespace(prefix + name + "::", is_visible && !name.empty());
        if (!Ends()) ++at_;
      } else if (Here() == "template") {
        ++at_;
        if (!Ends() && Here() == "<") Skip("<", ">");
      } else if (Here() == "class" || Here() == "struct" || Here() == "union" || Here() == "enum") {
        ReadType(prefix, is_visible);
      } else if (Here() == "{") {
        Skip("{", "}");
      } else if (Here() == "(") {
        Skip("(", ")");
      } else {
        ++at_;
      }
    }
  }

  void ReadType(const std::string& prefix, bool is_visible) {
    while (!Ends() && (Here() == "class" || Here() == "struct" || Here() == "union" ||
                       Here() == "enum" || Here() == "alignas" || Here() == "[")) {
      const bool has_arguments = Here() == "alignas";
      if (Here() == "[") {
        Skip("[", "]");
        continue;
      }
      ++at_;
      if (has_arguments) Skip("(", ")");
    }
    if (Ends()) return;
    Token name = tokens_[at_++];
    while (!Ends() && Here() == "::" && at_ + 1 < tokens_.size()) {
      name.text += "::" + tokens_[at_ + 1].text;
      at_ += 2;
    }
    // A specialisation is told from others by its arguments, not by its name.
    if (!Ends() && Here() == "<") is_visible = false;
    // A definition has a body before anything that ends or uses a declaration.
    while (!Ends() && Here() != "{" && Here() != ";" && Here() != "(" && Here() != "=") {
      if (Here() == "<") {
        Skip("<", ">");
      } else {
        ++at_;
      }
    }
    if (!Ends() && Here() == "{" && is_visible) found_.push_back({prefix + name.text, name.line});
  }

  const std::vector<Token> tokens_;
  std::size_t at_ = 0;
  std::vector<DefinedType> found_;
};

}  // namespace

std::vector<DefinedType> FindDefinedTypes(const std::string& text) { return Finder(text).Run(); }

}  // namespace sidestep
