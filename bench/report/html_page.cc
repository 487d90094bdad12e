#include "sidestep/bench/report/html_page.h"

#include <fmt/core.h>

#include <fstream>
#include <iterator>

#include "sidestep/core/input_error.h"
#include "sidestep/core/markup.h"
#include "sidestep/core/utf8.h"

namespace sidestep::bench {
namespace {

constexpr const char* kStyle = R"(
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 62rem; margin: 2rem auto;
       padding: 0 1rem; }
h1 { font-size: 1.7rem; } h2 { font-size: 1.25rem; margin-top: 2.2rem; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums;
        font-size: 0.9rem; }
th, td { padding: 0.25rem 0.7rem; text-align: right; border-bottom: 1px solid #ddd; }
th { border-bottom: 2px solid #888; vertical-align: bottom; }
th:first-child, td:first-child { text-align: left; }
figure { margin: 1.5rem 0; } figure img { max-width: 100%; }
figcaption { color: #555; font-size: 0.9rem; }
)";

// As a picture of its own and not as part of the page: then names inside two pictures cannot clash.
std::string DataUri(const std::string& svg) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
  const std::string plain = std::string(kPlain) + "-_.!~*() =:/,;+@?";
  std::string uri = "data:image/svg+xml,";
  for (const char c : svg) {
    if (plain.find(c) != std::string::npos) {
      uri += c;
    } else {
      uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
  }
  return uri;
}

}  // namespace

std::string Escaped(const std::string& text) { return EscapeMarkup(EscapeInvalidUtf8(text)); }

HtmlPage::HtmlPage(const std::string& title) {
  text_ =
      "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>" +
      Escaped(title) + "</title>\n<style>" + kStyle + "</style>\n<h1>" + Escaped(title) + "</h1>\n";
}

void HtmlPage::Heading(const std::string& text) { text_ += "<h2>" + Escaped(text) + "</h2>\n"; }

void HtmlPage::Paragraph(const std::string& text) { text_ += "<p>" + Escaped(text) + "</p>\n"; }

void HtmlPage::Table(const TextTable& table) {
  text_ += "<table>\n";
  std::string tag = "th";
  for (const std::vector<std::string>& row : table) {
    text_ += "<tr>";
    for (const std::string& cell : row) text_ += "<" + tag + ">" + Escaped(cell) + "</" + tag + ">";
    text_ += "</tr>\n";
    tag = "td";
  }
  text_ += "</table>\n";
}

void HtmlPage::Picture(const std::string& svg_path, const std::string& caption) {
  std::ifstream stream(svg_path, std::ios::binary);
  if (!stream) throw InputError(svg_path, "cannot be read");
  const std::string svg{std::istreambuf_iterator<char>(stream), {}};
  text_ += "<figure><img alt=\"" + Escaped(caption) + "\" src=\"" + DataUri(svg) +
           "\"><figcaption>" + Escaped(caption) + "</figcaption></figure>\n";
}

std::string HtmlPage::ToText() const { return text_ + "</html>\n"; }

}  // namespace sidestep::bench
