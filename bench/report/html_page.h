#pragma once

#include <string>

#include "sidestep/bench/report/table.h"

namespace sidestep::bench {

/// What HTML and SVG take as it stands, also bytes that are no UTF-8.
std::string Escaped(const std::string& text);

/// A page that stands alone: text, tables and pictures in one file, to be read top to bottom. Texts
/// are plain: what means something in HTML is escaped, and bytes that are not UTF-8.
class HtmlPage {
 public:
  explicit HtmlPage(const std::string& title);

  void Heading(const std::string& text);
  void Paragraph(const std::string& text);
  void Table(const TextTable& table);
  /// Puts a copy of an SVG file into the page. @throws InputError if it cannot be read.
  void Picture(const std::string& svg_path, const std::string& caption);

  std::string ToText() const;

 private:
  std::string text_;
};

}  // namespace sidestep::bench
