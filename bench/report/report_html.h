#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/report/comparison.h"
#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/report/run_table.h"

namespace sidestep::bench {

// Pieces of a report's page. Texts are plain but where a name ends in _html.

std::string Heading(const std::string& text);
std::string Paragraph(const std::string& text_html, const std::string& css_class = "");
/// With a caption, in the colours of the page.
std::string FigureHtml(const Panel& panel, const std::string& caption);
/// A name as HTML that may be broken after its underscores.
std::string Breakable(const std::string& name);
/// The first row is its head. Cells are HTML. A row of one cell in a table of several columns goes
/// across all of them, and belongs to the row above.
std::string TableHtml(const std::vector<std::vector<std::string>>& rows_html,
                      const std::vector<std::string>& column_classes = {});
/// A command with a button that copies it.
std::string CommandHtml(const std::string& command);

/// "91.7 %".
std::string Percent(double share);
/// "p = 0.0078", "p < 0.0001".
std::string PText(double p);

/// What is answered, in one sentence: both rates, their difference, its interval, n and p. With
/// `bold_html` its figures stand in bold, and it is HTML.
std::string AnswerSentence(const RunTable& runs, const Comparison& comparison, bool bold_html);
/// How interval and p were found, and what was left out.
std::string AnswerNote(const RunTable& runs, const Comparison& comparison);
/// The compared metrics, if there are any.
std::string MetricsTableHtml(const RunTable& runs, const Comparison& comparison);

}  // namespace sidestep::bench
