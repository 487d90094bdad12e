#pragma once

#include <string>
#include <vector>

#include "sidestep/bench/database/run_database.h"
#include "sidestep/bench/report/comparison.h"
#include "sidestep/bench/report/figure.h"
#include "sidestep/bench/report/run_table.h"

namespace sidestep::bench {

/// What a report is asked.
struct ReportRequest {
  /// Two levels of a factor, in words; empty: what the database's sweep asks, or the first there
  /// is.
  std::string factor, of, with;
  std::string over;  ///< the factor along which they are shown; empty: chosen
  /// The database's name and its folder with a `/` at the end (or nothing), as a shell takes them:
  /// for commands that the page tells.
  std::string database, folder;
};

/// A run that is replayed in the page.
struct ReportReplay {
  std::string title;
  std::string json;  ///< as render::ReplayJson writes it
};
/// Replays, with the style and the scripts that show them.
struct ReportReplays {
  std::vector<ReportReplay> replays;
  std::string style, scripts;
};

/// A picture of the report that is worth a file of its own.
struct ReportFigure {
  std::string name;  ///< of the file, without its ending
  Panel panel;
};

struct SweepReport {
  std::string answer;  ///< the sentence that the page begins with, as plain text
  std::string html;
  std::vector<ReportFigure> figures;
};

/// A database, read and asked.
class ReportSource {
 public:
  /// @throws InputError `--compare: WHY` or `--over: WHY` for what it does not hold.
  ReportSource(const RunDatabase& database, const ReportRequest& request);

  const RunTable& runs() const { return runs_; }
  const Question& question() const { return question_; }  ///< factor -1: nothing varies

  /// Pairs of the question's runs whose outcomes differ most: first those of which only the second,
  /// then those of which only the first touched something or did not arrive, then by the difference
  /// of the least clearance.
  std::vector<std::pair<std::size_t, std::size_t>> TellingPairs() const;

  SweepReport Make(const ReportReplays& replays) const;

 private:
  const RunDatabase& database_;
  ReportRequest request_;
  RunTable runs_;
  Question question_;
  int over_ = -1;
};

}  // namespace sidestep::bench
